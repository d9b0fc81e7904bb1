// SPDX-License-Identifier: MIT
#include "daemon/nats/stream.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "daemon/nats/jetstream_api.h"
#include "daemon/nats/stretch_reader.h"

namespace camway::nats {

using nlohmann::json;
using std::chrono::milliseconds;

namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
/// The server remembers ids of messages for so long. None has one.
constexpr std::int64_t kDuplicates_ns = kNanosecondsPerSecond;

constexpr milliseconds kEnsurePause{100};
/// A cluster without a leader does not answer.
constexpr milliseconds kEnsureWait{1000};

json config_of(const StreamConfig& config) {
  json value{{"name", config.name},
             {"subjects", {config.subject}},
             {"retention", "limits"},
             {"storage", "file"},
             {"discard", "new"},
             {"max_msgs", -1},
             {"max_age", 0},
             {"max_bytes", config.most_bytes == 0 ? json(-1) : json(config.most_bytes)},
             {"max_msgs_per_subject", config.one_for_a_subject ? 1 : -1},
             {"num_replicas", config.replicas},
             {"duplicate_window", kDuplicates_ns},
             {"allow_direct", true}};
  if (!config.news.empty()) {
    value["republish"] = {
        {"src", config.subject}, {"dest", config.news + ".>"}, {"headers_only", true}};
  }
  return value;
}

/// Returns how a stream differs from how it should be, in what cannot be changed.
std::string fault_of_config(const json& is, const json& wanted) {
  for (const char* const key : {"subjects", "retention", "storage", "discard", "max_msgs",
                                "max_age", "max_msgs_per_subject", "allow_direct", "republish"}) {
    const json found = is.contains(key) ? is.at(key) : json();
    const json other = wanted.contains(key) ? wanted.at(key) : json();
    if (found != other) {
      return std::string(key) + " is " + found.dump() + ", not " + other.dump();
    }
  }
  return "";
}

std::string named(const std::string& stream, const std::string& error) {
  return "stream " + stream + ": " + error;
}

/// Sets replicas and limit of a stream that is there. Returns why that failed.
std::string adapt(Connection& connection, const StreamConfig& config, json is, milliseconds wait) {
  json wanted = config_of(config);
  std::string fault = fault_of_config(is, wanted);
  if (!fault.empty()) {
    return named(config.name, "was made for something else, or by another version: " + fault);
  }
  if (config.most_bytes == 0 && is.contains("max_bytes")) wanted["max_bytes"] = is["max_bytes"];
  bool differs = false;
  for (const char* const key : {"max_bytes", "num_replicas"}) {
    differs = differs || !is.contains(key) || is[key] != wanted[key];
    is[key] = wanted[key];
  }
  if (!differs) return "";
  const auto answer = ask_api(connection, "STREAM.UPDATE." + config.name, is, wait);
  if (!answer) return named(config.name, answer.error);
  return answer->error_code == 0 ? "" : named(config.name, answer->error_text);
}

struct Ensured {
  std::string error;  ///< empty if the stream is there
  bool may_pass = false;
};

Ensured ensure_once(Connection& connection, const StreamConfig& config, milliseconds wait) {
  const auto info = ask_api(connection, "STREAM.INFO." + config.name, nullptr, wait);
  if (!info && info.error == kNobodyAnswers) {
    return {connection.server() + " has no JetStream, or not for this user"};
  }
  if (!info) return {named(config.name, info.error), info.fault != StreamFault::kStalled};
  if (info->error_code == 0 && info->value.contains("config")) {
    return {adapt(connection, config, info->value["config"], wait)};
  }
  if (info->error_code != kStreamNotFoundError) {
    return {named(config.name, info->error_text),
            fault_of_error(info->error_code) == StreamFault::kUnreachable};
  }
  const auto made = ask_api(connection, "STREAM.CREATE." + config.name, config_of(config), wait);
  if (!made) return {named(config.name, made.error), true};
  if (made->error_code == 0) return {};
  // If another process has just made it, the next try finds it.
  return {named(config.name, made->error_text),
          made->error_code == kStreamNameError || made->error_code == kNoPeersError ||
              fault_of_error(made->error_code) == StreamFault::kUnreachable};
}

std::uint64_t number_in(const json& value, const char* key) {
  const auto found = value.find(key);
  return found != value.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

}  // namespace

base::Result<std::unique_ptr<Stream>> Stream::ensure(Connection& connection,
                                                     const StreamConfig& config, Wait wait) {
  if (config.replicas == 1) connection.parts().stalls->watch(config.name);
  const auto end = std::chrono::steady_clock::now() + wait;
  for (;;) {
    const Ensured tried = ensure_once(connection, config, std::min(wait, kEnsureWait));
    if (tried.error.empty()) return std::unique_ptr<Stream>(new Stream(connection, config));
    // The servers of a cluster that has just started have no leader yet.
    if (!tried.may_pass || std::chrono::steady_clock::now() + kEnsurePause >= end) {
      return base::Failure{tried.error};
    }
    std::this_thread::sleep_for(kEnsurePause);
  }
}

std::string Stream::ensure_again(Wait wait) {
  const auto info = ask_api(connection_, "STREAM.INFO." + name_, nullptr, wait);
  if (!info) return named(name_, info.error);
  // Another process may have changed its limits since.
  if (info->error_code == 0) return "";
  return ensure_once(connection_, config_, wait).error;
}

StreamResult<std::uint64_t> Stream::publish(const std::string& subject,
                                            std::span<const std::uint8_t> payload,
                                            std::optional<std::uint64_t> expected, Wait wait) {
  natsMsg* made = nullptr;
  if (natsMsg_Create(&made, subject.c_str(), nullptr, reinterpret_cast<const char*>(payload.data()),
                     static_cast<int>(payload.size())) != NATS_OK) {
    return {StreamFault::kRefused, "'" + subject + "' cannot be sent"};
  }
  const NatsOwned<natsMsg> message(made);
  natsStatus status = natsMsgHeader_Set(made, "Nats-Expected-Stream", name_.c_str());
  // Clusters of NATS 2.9 compare 0 when the message is stored, each server for itself, after which
  // they may differ (nats-server issue 5644); other numbers are compared before.
  const bool is_sent = expected && (*expected > 0 || config_.replicas == 1);
  if (status == NATS_OK && is_sent) {
    status = natsMsgHeader_Set(made, "Nats-Expected-Last-Subject-Sequence",
                               std::to_string(*expected).c_str());
  }
  if (status != NATS_OK) return {StreamFault::kRefused, "no memory for NATS"};
  const auto reply = ask(connection_, name_, *message, wait);
  if (!reply) return {reply.fault, reply.error};
  const auto answer = api_answer_from(text_of(**reply));
  if (!answer) return {answer.fault, answer.error};
  if (answer->error_code != 0) return {fault_of_error(answer->error_code), answer->error_text};
  const std::uint64_t sequence = number_in(answer->value, "seq");
  if (sequence == 0) return {StreamFault::kRefused, "NATS answered without a sequence"};
  return sequence;
}

StreamResult<Stream::Found> Stream::last(const std::string& subject, Wait wait) {
  const auto answer =
      ask_api(connection_, "STREAM.MSG.GET." + name_, {{"last_by_subj", subject}}, wait);
  if (!answer) return {answer.fault, answer.error};
  return stored_message_from(*answer);
}

StreamResult<Stream::Found> Stream::last_of_any_server(const std::string& subject, Wait wait) {
  const std::string request = json{{"last_by_subj", subject}}.dump();
  natsMsg* made = nullptr;
  if (natsMsg_Create(&made, ("$JS.API.DIRECT.GET." + name_).c_str(), nullptr, request.data(),
                     static_cast<int>(request.size())) != NATS_OK) {
    return {StreamFault::kRefused, "no memory for NATS"};
  }
  const NatsOwned<natsMsg> message(made);
  const auto reply = ask(connection_, name_, *message, wait);
  if (!reply) return {reply.fault, reply.error};
  return direct_message_from(**reply);
}

std::shared_ptr<ReplyInbox> Stream::take_inbox() {
  {
    const std::lock_guard lock(mutex_);
    const NatsHandle handle = connection_.parts().connection();
    while (!inboxes_.empty()) {
      const std::shared_ptr<ReplyInbox> inbox = std::move(inboxes_.back());
      inboxes_.pop_back();
      if (inbox->is_idle(handle)) return inbox;
    }
  }
  return std::make_shared<ReplyInbox>(connection_);
}

void Stream::give_back(const std::shared_ptr<ReplyInbox>& inbox) {
  const std::lock_guard lock(mutex_);
  inboxes_.push_back(inbox);
}

StreamResult<std::uint64_t> Stream::read(std::uint64_t from, std::uint64_t to,
                                         const std::string& filter, const Handler& handler,
                                         Wait wait) {
  if (!connection_.is_connected()) {
    return {StreamFault::kUnreachable, "there is no connection to NATS"};
  }
  if (std::string stall = connection_.stall(); !stall.empty()) {
    return {StreamFault::kStalled, std::move(stall)};
  }
  const std::shared_ptr<ReplyInbox> replies = take_inbox();
  // With replicas, only the leader has all that was acknowledged.
  StretchReader reader(*replies, name_, filter, config_.replicas == 1, wait);
  std::uint64_t next = std::max<std::uint64_t>(from, 1);
  while (next <= to) {
    auto messages = reader.next(next, to);
    if (messages.error == kNoAnswerInTime) connection_.parts().stalls->suspect(name_);
    if (!messages) return {messages.fault, messages.error};
    if (messages->empty()) break;
    for (StoredMessage& message : *messages.value) {
      if (message.sequence < next) return {StreamFault::kRefused, "NATS answered out of order"};
      if (message.sequence > to) {
        give_back(replies);
        return to;
      }
      next = message.sequence + 1;
      handler(std::move(message));
    }
  }
  give_back(replies);
  return next - 1;
}

StreamResult<std::uint64_t> Stream::purge(const std::string& filter, std::uint64_t before,
                                          Wait wait) {
  std::vector<std::uint64_t> sequences;
  const auto collect = [&](const StoredMessage& message) {
    if (message.sequence < before) sequences.push_back(message.sequence);
  };
  if (before <= 1) return 0;
  const auto found = read(1, before - 1, filter, collect, wait);
  if (!found) return found;
  std::uint64_t purged = 0;
  for (const std::uint64_t sequence : sequences) {
    const auto removed = remove(sequence, wait);
    if (!removed) return {removed.fault, removed.error};
    if (*removed) ++purged;
  }
  return purged;
}

StreamResult<bool> Stream::remove(std::uint64_t sequence, Wait wait) {
  // Nothing secret is in it that the server would have to overwrite.
  const auto answer = ask_api(connection_, "STREAM.MSG.DELETE." + name_,
                              {{"seq", sequence}, {"no_erase", true}}, wait);
  if (!answer) return {answer.fault, answer.error};
  // The server says what its store has found if the message was deleted at the same time.
  const bool was_just_deleted = answer->error_code == kDeleteFailedError &&
                                answer->error_text.find("no message found") != std::string::npos;
  if (was_just_deleted || answer->error_code == kSequenceNotFoundError ||
      answer->error_code == kNoMessageError) {
    return false;
  }
  if (answer->error_code != 0) return {fault_of_error(answer->error_code), answer->error_text};
  return true;
}

StreamResult<StreamState> Stream::state(Wait wait) {
  const auto answer = ask_api(connection_, "STREAM.INFO." + name_, nullptr, wait);
  if (!answer) return {answer.fault, answer.error};
  if (answer->error_code != 0) return {fault_of_error(answer->error_code), answer->error_text};
  const auto state = answer->value.find("state");
  if (state == answer->value.end() || !state->is_object()) {
    return {StreamFault::kRefused, "NATS answered without a state"};
  }
  return StreamState{number_in(*state, "last_seq"), number_in(*state, "bytes")};
}

StreamResult<std::map<std::string, std::uint64_t>> Stream::subjects(const std::string& filter,
                                                                    Wait wait) {
  std::map<std::string, std::uint64_t> found;
  for (;;) {
    const auto answer = ask_api(connection_, "STREAM.INFO." + name_,
                                {{"subjects_filter", filter}, {"offset", found.size()}}, wait);
    if (!answer) return {answer.fault, answer.error};
    if (answer->error_code != 0) return {fault_of_error(answer->error_code), answer->error_text};
    const auto state = answer->value.find("state");
    if (state == answer->value.end() || !state->is_object()) {
      return {StreamFault::kRefused, "NATS answered without a state"};
    }
    const std::size_t before = found.size();
    if (const auto list = state->find("subjects"); list != state->end() && list->is_object()) {
      for (const auto& [subject, count] : list->items()) {
        found.emplace(subject, count.is_number_unsigned() ? count.get<std::uint64_t>() : 0);
      }
    }
    // The server gives a hundred thousand at once.
    if (found.size() == before || found.size() >= number_in(answer->value, "total")) return found;
  }
}

}  // namespace camway::nats
