// SPDX-License-Identifier: MIT
#include "tools/camway/replay/publisher.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include <camway/occupancy_request_t.hpp>
#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>
#include <camway/scene_request_t.hpp>
#include <camway/upload_page_t.hpp>

#include "daemon/messages/text.h"
#include "daemon/service/scenes/scene_operation.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/envelope.h"

namespace camway::tools {
namespace {

/// Pages that are sent before the daemon is asked which are missing: more would not fit the
/// buffers of sockets.
constexpr std::size_t kPagesAtOnce = 4;
/// Time after which the daemon is asked again which pages are missing.
constexpr std::chrono::milliseconds kAskAgain{500};

std::int64_t shifted(std::int64_t id, std::uint64_t shift) {
  // Unsigned numbers may overflow.
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(id) + shift);
}

}  // namespace

Publisher::Publisher(lcm::LCM& lcm, const wire::Channels& channels, wire::MessageAuth* auth,
                     const PublishedSession& session)
    : lcm_(lcm), channels_(channels), auth_(auth), session_(session) {
  const auto subscribe = [&](const std::string& channel, auto handler) {
    lcm_.subscribe(channel, handler, this)->setQueueCapacity(kQueueCapacity);
  };
  subscribe(channels_.plan_response(".*"), &Publisher::on_answer);
  subscribe(channels_.scene_response(".*"), &Publisher::on_scene_answer);
  subscribe(channels_.upload_status(".*"), &Publisher::on_upload_status);
  subscribe(channels_.status(), &Publisher::on_heartbeat);
}

bool Publisher::send(std::size_t index) {
  const record::LogEvent& event = session_.events[index];
  return publish(event.channel, fresh(event));
}

std::vector<std::uint8_t> Publisher::fresh(const record::LogEvent& event) {
  const auto shift_id = [&](auto& request) {
    request.request_id = shifted(request.request_id, id_shift_);
    return wire::encode(request);
  };
  if (event.channel == channels_.plan_request()) {
    auto decoded = wire::decode<plan_request_t>(event.data);
    if (!decoded.message) {
      if (wire::is_other_version(decoded.fault)) ++other_version_;
      return event.data;
    }
    const RequestKey recorded(decoded.message->client_id, decoded.message->request_id);
    // Revisions of this daemon have other numbers, and it has answered the changes before.
    decoded.message->least_revision = 0;
    std::vector<std::uint8_t> bytes = shift_id(*decoded.message);
    last_ = {decoded.message->client_id, decoded.message->request_id};
    is_last_change_ = false;
    asked_.emplace(last_, recorded);
    return bytes;
  }
  if (event.channel == channels_.scene_request()) {
    auto decoded = wire::decode<scene_request_t>(event.data);
    if (!decoded.message) return event.data;
    std::vector<std::uint8_t> bytes = shift_id(*decoded.message);
    last_ = {decoded.message->client_id, decoded.message->request_id};
    is_last_change_ = true;
    changes_.emplace(last_, fmt::format("{} of '{}' in the scene '{}'",
                                        service::operation_name(*decoded.message),
                                        wire::printable(decoded.message->object),
                                        wire::printable(service::target_of(*decoded.message))));
    return bytes;
  }
  if (event.channel == channels_.occupancy_request()) {
    auto decoded = wire::decode<occupancy_request_t>(event.data);
    if (decoded.message) return shift_id(*decoded.message);
  }
  return event.data;
}

bool Publisher::publish(const std::string& channel, const std::vector<std::uint8_t>& bytes) {
  const auto to_lcm = [&](const std::vector<std::uint8_t>& message) {
    return lcm_.publish(channel, message.data(), static_cast<unsigned int>(message.size())) == 0;
  };
  ++sent_;
  return auth_ != nullptr ? to_lcm(auth_->seal(channel, bytes)) : to_lcm(bytes);
}

void Publisher::prepare(std::size_t index, Clock::duration wait) {
  const auto request = wire::decode<scene_request_t>(session_.events[index].data);
  if (!is_change(index) || !request.message || request.message->upload_bytes <= 0) return;
  const UploadKey key(request.message->client_id, request.message->upload_bytes,
                      request.message->upload_checksum);
  const Clock::time_point end = Clock::now() + wait;
  std::vector<std::int32_t> missing;
  do {
    upload_status_.reset();
    if (!ask_upload(key, missing)) return;
    const auto is_told = [&] {
      return upload_status_ && upload_status_->client_id == std::get<0>(key) &&
             upload_status_->checksum == std::get<2>(key);
    };
    listen_until(std::min(end, Clock::now() + kAskAgain), is_told);
    if (!is_told()) continue;
    const bool is_ok = upload_status_->status == upload_status_t::STATUS_OK;
    if (!is_ok || upload_status_->total_missing == 0) return;
    missing = upload_status_->missing;
  } while (Clock::now() < end);
}

/// Sends some of these pages, and asks which are missing then.
bool Publisher::ask_upload(const UploadKey& key, const std::vector<std::int32_t>& pages) {
  const auto& indices = session_.uploads.at(key);
  for (std::size_t i = 0; i < std::min(pages.size(), kPagesAtOnce); ++i) {
    const auto page = indices.find(pages[i]);
    if (page != indices.end() && !send(page->second)) return false;
  }
  auto question = wire::decode<upload_page_t>(session_.events[indices.begin()->second].data);
  if (!question.message) return false;
  question.message->page = 0;
  question.message->page_checksum = 0;
  question.message->num_bytes = 0;
  question.message->bytes.clear();
  return publish(channels_.upload(), wire::encode(*question.message));
}

bool Publisher::is_change(std::size_t index) const {
  return session_.events[index].channel == channels_.scene_request();
}

bool Publisher::continues_last(std::size_t index) const {
  const record::LogEvent& event = session_.events[index];
  if (event.channel != channels_.plan_request() || is_last_change_) return false;
  const auto sender = wire::peek_sender(wire::layout_of<plan_request_t>(), event.data);
  return sender && last_ == RequestKey(sender->client_id, shifted(sender->request_id, id_shift_));
}

bool Publisher::is_last_answered() const {
  if (is_last_change_) return made_.contains(last_);
  return asked_.empty() || answers_.contains(last_);
}

PublishTally Publisher::tally() const {
  PublishTally tally;
  tally.sent = sent_;
  tally.other_version = other_version_;
  tally.asked = asked_.size();
  tally.is_heard = is_heard_;
  for (const auto& [sent, recorded] : asked_) {
    const auto answer = answers_.find(sent);
    if (answer == answers_.end()) {
      tally.unanswered.push_back(recorded);
    } else {
      ++tally.by_status[answer->second];
    }
  }
  tally.changes = changes_.size();
  for (const auto& [sent, what] : changes_) {
    const auto answer = made_.find(sent);
    if (answer == made_.end()) {
      tally.unmade.push_back(what + ": no answer");
    } else if (answer->second.status != scene_response_t::STATUS_OK) {
      tally.unmade.push_back(fmt::format("{}: {}: {}", what,
                                         messages::status_name(answer->second.status),
                                         wire::printable(answer->second.message)));
    } else {
      ++tally.made_changes;
    }
  }
  return tally;
}

std::optional<std::vector<std::uint8_t>> Publisher::opened(const lcm::ReceiveBuffer* buffer,
                                                           const std::string& channel) {
  const std::span bytes(static_cast<const std::uint8_t*>(buffer->data), buffer->data_size);
  const auto message =
      auth_ != nullptr ? auth_->open(channel, bytes).message : wire::payload_unchecked(bytes);
  if (!message) return std::nullopt;
  is_heard_ = true;
  return std::vector<std::uint8_t>(message->begin(), message->end());
}

void Publisher::on_answer(const lcm::ReceiveBuffer* buffer, const std::string& channel) noexcept {
  const auto bytes = opened(buffer, channel);
  if (!bytes) return;
  const auto answer = wire::decode<plan_response_t>(*bytes);
  const auto sender = wire::peek_sender(wire::layout_of<plan_response_t>(), *bytes);
  if (!sender) return;
  RequestKey key(sender->client_id, sender->request_id);
  if (!asked_.contains(key)) return;
  answers_.try_emplace(std::move(key), answer.message
                                           ? messages::status_name(answer.message->status)
                                           : "unreadable");
}

void Publisher::on_scene_answer(const lcm::ReceiveBuffer* buffer,
                                const std::string& channel) noexcept {
  const auto bytes = opened(buffer, channel);
  if (!bytes) return;
  auto answer = wire::decode<scene_response_t>(*bytes);
  if (!answer.message) return;
  RequestKey key(answer.message->client_id, answer.message->request_id);
  if (changes_.contains(key)) made_.try_emplace(std::move(key), *std::move(answer.message));
}

void Publisher::on_upload_status(const lcm::ReceiveBuffer* buffer,
                                 const std::string& channel) noexcept {
  const auto bytes = opened(buffer, channel);
  if (!bytes) return;
  upload_status_ = wire::decode<upload_status_t>(*bytes).message;
}

void Publisher::on_heartbeat(const lcm::ReceiveBuffer* buffer,
                             const std::string& channel) noexcept {
  opened(buffer, channel);
}

}  // namespace camway::tools
