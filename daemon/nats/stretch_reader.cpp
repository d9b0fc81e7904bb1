// SPDX-License-Identifier: MIT
#include "daemon/nats/stretch_reader.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "daemon/nats/jetstream_api.h"

namespace camway::nats {
namespace {

/// Messages have up to a megabyte.
constexpr std::size_t kMostAtOnce = 32;
constexpr std::string_view kNotFoundStatus = "404";

std::uint64_t number_from(std::string_view text) {
  std::uint64_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

}  // namespace

ReplyInbox::ReplyInbox(Connection& connection)
    : parts_(connection.parts()), handle_(parts_.connection()) {
  natsInbox* inbox = nullptr;
  if (natsInbox_Create(&inbox) != NATS_OK) return;
  inbox_.reset(inbox);
  natsSubscription* made = nullptr;
  const std::string subject = std::string(inbox) + ".*";
  if (natsConnection_SubscribeSync(&made, handle_.get(), subject.c_str()) != NATS_OK) return;
  subscription_.reset(made);
  natsSubscription_SetPendingLimits(made, -1, -1);
}

ReplyInbox::~ReplyInbox() {
  const std::lock_guard lock(parts_.mutex);
  parts_.retire(std::move(subscription_));
}

bool ReplyInbox::ask(const std::string& subject, const std::string& request, std::size_t number) {
  if (subscription_ == nullptr) return false;
  ++awaited_;
  const std::string reply = std::string(inbox_.get()) + "." + std::to_string(number);
  return natsConnection_PublishRequest(handle_.get(), subject.c_str(), reply.c_str(),
                                       request.data(), static_cast<int>(request.size())) == NATS_OK;
}

NatsOwned<natsMsg> ReplyInbox::next(std::chrono::milliseconds wait) {
  natsMsg* message = nullptr;
  natsSubscription_NextMsg(&message, subscription_.get(), wait.count());
  if (message != nullptr) --awaited_;
  return NatsOwned<natsMsg>(message);
}

std::size_t ReplyInbox::number_of(natsMsg& reply) {
  const std::string_view subject = natsMsg_GetSubject(&reply);
  return number_from(subject.substr(subject.rfind('.') + 1));
}

StreamResult<Stream::Found> direct_message_from(natsMsg& reply) {
  const char* status = nullptr;
  const char* sequence = nullptr;
  const char* subject = nullptr;
  natsMsgHeader_Get(&reply, "Status", &status);
  natsMsgHeader_Get(&reply, "Nats-Sequence", &sequence);
  natsMsgHeader_Get(&reply, "Nats-Subject", &subject);
  if (sequence != nullptr && subject != nullptr) {
    const std::string_view bytes = text_of(reply);
    return Stream::Found(
        StoredMessage{subject, number_from(sequence), {bytes.begin(), bytes.end()}});
  }
  if (status != nullptr && std::string_view(status) == kNotFoundStatus) return Stream::Found{};
  return {StreamFault::kUnreachable, kNobodyAnswers};
}

StretchReader::StretchReader(ReplyInbox& replies, const std::string& stream, std::string filter,
                             bool is_direct, std::chrono::milliseconds wait)
    : replies_(replies),
      is_direct_(is_direct),
      subject_((is_direct ? "$JS.API.DIRECT.GET." : "$JS.API.STREAM.MSG.GET.") + stream),
      filter_(std::move(filter)),
      wait_(wait) {}

StreamResult<Stream::Found> StretchReader::message_from(natsMsg& reply) const {
  if (is_direct_) return direct_message_from(reply);
  const auto answer = api_answer_from(text_of(reply));
  if (!answer) return {answer.fault, answer.error};
  return stored_message_from(*answer);
}

StreamResult<std::vector<Stream::Found>> StretchReader::ask_for(std::uint64_t from,
                                                                std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const nlohmann::json request{{"seq", from + i}, {"next_by_subj", filter_}};
    if (!replies_.ask(subject_, request.dump(), i)) {
      return {StreamFault::kUnreachable, "the connection to NATS was lost"};
    }
  }
  std::vector<Stream::Found> found(count);
  for (std::size_t i = 0; i < count; ++i) {
    const NatsOwned<natsMsg> reply = replies_.next(wait_);
    if (reply == nullptr) return {StreamFault::kUnreachable, kNoAnswerInTime};
    StreamResult<Stream::Found> message = message_from(*reply);
    if (!message) return {message.fault, message.error};
    const std::size_t number = ReplyInbox::number_of(*reply);
    if (number >= count) return {StreamFault::kRefused, "NATS answered what was not asked"};
    found[number] = *std::move(message);
  }
  return found;
}

StreamResult<std::vector<StoredMessage>> StretchReader::next(std::uint64_t from, std::uint64_t to) {
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(at_once_, to - from + 1));
  auto found = ask_for(from, count);
  if (!found) return {found.fault, found.error};
  std::vector<StoredMessage> messages;
  std::uint64_t next = from;
  for (std::size_t i = 0; i < count; ++i) {
    if (from + i < next) continue;
    Stream::Found& message = (*found.value)[i];
    // Where one answer has none, the next ones may have messages that were stored later, beside
    // others that none of them has.
    if (!message) break;
    next = message->sequence + 1;
    messages.push_back(*std::move(message));
  }
  at_once_ = messages.size() == count ? std::min(2 * at_once_, kMostAtOnce)
                                      : std::max<std::size_t>(messages.size(), 1);
  return messages;
}

}  // namespace camway::nats
