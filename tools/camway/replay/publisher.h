// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <camway/scene_response_t.hpp>
#include <camway/upload_status_t.hpp>
#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/wire/auth/message_auth.h"
#include "lcmtypes/wire/channels.h"
#include "tools/camway/replay/published_session.h"

namespace camway::tools {

/// Client and id of a request.
using RequestKey = std::pair<std::string, std::int64_t>;

/// Counts of sent messages and of their answers. Requests have their recorded ids.
struct PublishTally {
  std::size_t sent = 0;           ///< messages
  std::size_t other_version = 0;  ///< planning requests that a daemon of this version cannot read
  std::size_t asked = 0;          ///< planning requests
  std::map<std::string, std::size_t> by_status;  ///< answers to planning requests
  std::vector<RequestKey> unanswered;            ///< planning requests
  std::size_t changes = 0;                       ///< of scenes, that were asked for
  std::size_t made_changes = 0;
  std::vector<std::string> unmade;  ///< changes that were not made, a sentence each
  bool is_heard = false;            ///< whether a daemon sent anything

  [[nodiscard]] std::size_t answered() const { return asked - unanswered.size(); }
};

/// Sends messages of a session and collects the answers, all on the calling thread. The ids of
/// requests are sent shifted, since a daemon has the answers to those that it has heard.
class Publisher {
 public:
  using Clock = std::chrono::steady_clock;

  /// `auth` may be null. The others must outlive this.
  Publisher(lcm::LCM& lcm, const wire::Channels& channels, wire::MessageAuth* auth,
            const PublishedSession& session);

  /// Sets the number that is added to the ids of all requests; they may overflow.
  void set_id_shift(std::uint64_t shift) { id_shift_ = shift; }

  /// Sends the event of this index. Returns false if LCM refused it.
  bool send(std::size_t index);
  /// Waits for what an event needs before it is sent: all pages of its upload at the daemon. Sends
  /// those again that were lost, until `wait` is over.
  void prepare(std::size_t index, Clock::duration wait);
  /// Receives answers until `time`, or until `is_enough` returns true.
  template <class IsEnough>
  void listen_until(Clock::time_point time, const IsEnough& is_enough) {
    while (Clock::now() < time && !is_enough()) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(time - Clock::now());
      lcm_.handleTimeout(static_cast<int>(std::min<std::int64_t>(left.count(), kSliceMs)));
    }
  }

  [[nodiscard]] bool is_change(std::size_t index) const;
  /// Whether an event is a page of the planning request that was sent last.
  [[nodiscard]] bool continues_last(std::size_t index) const;
  /// Whether the request for planning or for a change that was sent last is answered; true if none
  /// was sent.
  [[nodiscard]] bool is_last_answered() const;
  [[nodiscard]] bool are_all_answered() const { return answers_.size() == asked_.size(); }
  [[nodiscard]] bool is_heard() const { return is_heard_; }
  [[nodiscard]] PublishTally tally() const;

 private:
  static constexpr int kQueueCapacity = 4096;
  static constexpr std::int64_t kSliceMs = 100;

  /// Returns an event as it is sent, and notes what it asks for.
  std::vector<std::uint8_t> fresh(const record::LogEvent& event);
  bool publish(const std::string& channel, const std::vector<std::uint8_t>& bytes);
  bool ask_upload(const UploadKey& key, const std::vector<std::int32_t>& pages);
  std::optional<std::vector<std::uint8_t>> opened(const lcm::ReceiveBuffer* buffer,
                                                  const std::string& channel);
  void on_answer(const lcm::ReceiveBuffer* buffer, const std::string& channel) noexcept;
  void on_scene_answer(const lcm::ReceiveBuffer* buffer, const std::string& channel) noexcept;
  void on_upload_status(const lcm::ReceiveBuffer* buffer, const std::string& channel) noexcept;
  void on_heartbeat(const lcm::ReceiveBuffer* buffer, const std::string& channel) noexcept;

  lcm::LCM& lcm_;
  const wire::Channels& channels_;
  wire::MessageAuth* auth_;
  const PublishedSession& session_;
  std::uint64_t id_shift_ = 0;
  std::map<RequestKey, RequestKey> asked_;        ///< recorded planning requests by those sent
  std::map<RequestKey, std::string> answers_;     ///< statuses by planning requests as sent
  std::map<RequestKey, std::string> changes_;     ///< changes as sent, with words for people
  std::map<RequestKey, scene_response_t> made_;   ///< answers to them
  std::optional<upload_status_t> upload_status_;  ///< the last one
  RequestKey last_;
  bool is_last_change_ = false;
  bool is_heard_ = false;
  std::size_t sent_ = 0;  ///< messages
  std::size_t other_version_ = 0;
};

}  // namespace camway::tools
