// SPDX-License-Identifier: MIT
#include "tools/camway/replay/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "daemon/base/digest.h"
#include "daemon/messages/text.h"
#include "lcmtypes/wire/channels.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/page_assembly.h"
#include "lcmtypes/wire/path_fault.h"
#include "tools/camway/replay/signed_event.h"

namespace camway::tools {
namespace {

using Key = std::pair<std::string, std::int64_t>;  // client and request id

/// Returns the digest of a request without its ids. Changes them.
std::string content_digest_of(plan_request_t& whole) {
  whole.client_id.clear();
  whole.request_id = 0;
  const wire::Bytes content = wire::encode(whole);
  base::Digest digest;
  digest.add(content.data(), content.size());
  return digest.text();
}

class SessionBuilder {
 public:
  SessionBuilder(const std::string& prefix, const wire::MessageKeys* keys)
      : keys_(keys),
        request_channel_(wire::Channels{prefix}.plan_request()),
        response_channels_(wire::Channels{prefix}.plan_response("")),
        scene_channel_(wire::Channels{prefix}.scene_request()),
        session_channel_(record::session_channel(prefix)) {}

  [[nodiscard]] bool wants(std::string_view channel) const {
    return channel == request_channel_ || channel.starts_with(response_channels_) ||
           channel == scene_channel_ || channel == session_channel_;
  }

  /// Each file says for itself in which recording it stands.
  void begin_file() { recording_.clear(); }

  void add(record::LogEvent event) {
    if (is_first_) session_.begin_utime = event.utime;
    is_first_ = false;
    // As doubles the difference cannot overflow.
    received_s_ = (static_cast<double>(event.utime) - static_cast<double>(session_.begin_utime)) /
                  kMicroseconds;
    if (event.channel == session_channel_) return add_session_event(event);
    if (event.channel == scene_channel_) return static_cast<void>(++session_.scene_requests);
    const bool request = event.channel == request_channel_;
    if (open_event(keys_, event)) {
      ++session_.distrusted;
    } else if (request) {
      add_page<plan_request_t>(event, request_pages_,
                               [this](plan_request_t&& whole) { add_request(std::move(whole)); });
    } else {
      add_page<plan_response_t>(event, response_pages_,
                                [this](plan_response_t&& whole) { add_answer(std::move(whole)); });
    }
  }

  Session take() {
    session_.incomplete = request_pages_.half_received() + response_pages_.half_received();
    for (auto& [key, answer] : answers_) {
      const auto found = index_.find(key);
      if (found == index_.end()) {
        ++session_.unasked;
      } else {
        session_.requests[found->second].answer = std::move(answer);
      }
    }
    for (const RecordedRequest& request : session_.requests) {
      if (!request.answer || request.answer->scene_digest.empty()) continue;
      session_.first_digests.try_emplace(request.scene, request.answer->scene_digest);
    }
    return std::move(session_);
  }

 private:
  void add_session_event(const record::LogEvent& event) {
    base::Result<record::SessionEvent> read = record::session_event_from(event.data);
    if (!read) {
      ++session_.damaged_events;
    } else if (auto* const begin = std::get_if<record::FileBegin>(&*read)) {
      recording_ = begin->recording;
      session_.parts.push_back(std::move(*begin));
    } else if (auto* const update = std::get_if<record::SceneUpdate>(&*read)) {
      session_.updates.push_back({recording_, std::move(*update)});
    } else {
      add_omission(std::get<record::Omission>(*std::move(read)));
    }
  }

  /// Adds an omission to those with the same reason: a disk that is full now and then makes many.
  void add_omission(record::Omission omission) {
    for (record::Omission& sum : session_.omissions) {
      if (sum.reason != omission.reason) continue;
      sum.from_utime = std::min(sum.from_utime, omission.from_utime);
      sum.to_utime = std::max(sum.to_utime, omission.to_utime);
      sum.messages += omission.messages;
      sum.changes += omission.changes;
      return;
    }
    session_.omissions.push_back(std::move(omission));
  }

  template <typename Message, typename UseWhole>
  void add_page(const record::LogEvent& event, wire::PageAssembly<Message>& pages,
                UseWhole use_whole) {
    wire::Decoded<Message> decoded = wire::decode<Message>(event.data);
    if (!decoded.message) {
      ++session_.malformed;
      if (wire::is_other_version(decoded.fault)) ++session_.other_version;
      return;
    }
    auto outcome = pages.add(std::move(*decoded.message));
    if (!outcome.error.empty()) ++session_.malformed;
    if (outcome.whole) use_whole(std::move(*outcome.whole));
  }

  void add_request(plan_request_t whole) {
    // A daemon answers no other ids, and ids become file names here.
    if (!wire::is_client_id(whole.client_id)) {
      ++session_.malformed;
      return;
    }
    RecordedRequest recorded;
    recorded.ids = {whole.client_id, whole.request_id, whole.utime};
    recorded.scene = whole.scene;
    recorded.sent = 1;
    base::Result<planning::PlanRequest> converted = messages::from_wire(whole);
    recorded.request = std::move(converted.value);
    recorded.error = std::move(converted.error);
    recorded.received_s = received_s_;
    whole.utime = 0;  // does not count as content
    base::Digest all;
    const wire::Bytes bytes = wire::encode(whole);
    all.add(bytes.data(), bytes.size());
    const base::Digest::Bytes content = all.bytes();
    recorded.content_digest = content_digest_of(whole);
    const auto [position, is_new] =
        index_.try_emplace({recorded.ids.client_id, recorded.ids.request_id}, contents_.size());
    if (is_new) {
      session_.requests.push_back(std::move(recorded));
      contents_.push_back(content);
    } else if (contents_[position->second] == content) {
      ++session_.requests[position->second].sent;
    } else {
      ++session_.conflicts;
    }
  }

  void add_answer(plan_response_t whole) {
    const auto [position, is_new] = answers_.try_emplace({whole.client_id, whole.request_id});
    RecordedAnswer answer;
    answer.status = messages::status_name(whole.status);
    answer.scene_digest = whole.scene_digest;
    answer.received_s = received_s_;
    answer.scene_revision = static_cast<std::uint64_t>(whole.scene_revision);
    answer.recording = recording_;
    const bool is_result = base::value_of<planning::Status>(whole.status).has_value();
    if (is_result && wire::path_fault(whole.segments).empty()) answer.result = std::move(whole);
    if (is_new || (!position->second.result && answer.result)) position->second = std::move(answer);
  }

  static constexpr double kMicroseconds = 1e6;

  const wire::MessageKeys* keys_;
  bool is_first_ = true;
  double received_s_ = 0.0;  ///< time of the event that is added, from the first one
  std::string request_channel_;
  std::string response_channels_;
  std::string scene_channel_;
  std::string session_channel_;
  std::string recording_;  ///< that the present file belongs to
  wire::PageAssembly<plan_request_t> request_pages_;
  wire::PageAssembly<plan_response_t> response_pages_;
  std::map<Key, std::size_t> index_;
  std::vector<base::Digest::Bytes> contents_;
  std::map<Key, RecordedAnswer> answers_;
  Session session_;
};

}  // namespace

Session read_session(const std::filesystem::path& log, const std::string& prefix,
                     const wire::MessageKeys* keys) {
  return read_session(std::vector{log}, prefix, keys);
}

Session read_session(const std::vector<std::filesystem::path>& logs, const std::string& prefix,
                     const wire::MessageKeys* keys) {
  SessionBuilder builder(prefix, keys);
  record::LogSummary all;
  for (const std::filesystem::path& log : logs) {
    builder.begin_file();
    const record::LogSummary summary = record::read_event_log(
        log, [&](std::string_view channel) { return builder.wants(channel); },
        [&](record::LogEvent&& event) { builder.add(std::move(event)); });
    all.events += summary.events;
    all.bytes_used += summary.bytes_used;
    all.bytes += summary.bytes;
    if (!all.damage.empty() && !summary.damage.empty()) all.damage += "; ";
    all.damage += summary.damage;
  }
  Session session = builder.take();
  session.log = std::move(all);
  return session;
}

}  // namespace camway::tools
