// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "camway/client.h"
#include "client/exchange.h"
#include "client/link.h"
#include "lcmtypes/channels.h"

namespace camway {

/// How a call failed, with a text for a person.
struct Failure {
  Status status;
  std::string error;
};

template <class Answer>
Answer failed(Failure failure) {
  Answer answer;
  answer.status = failure.status;
  answer.error = std::move(failure.error);
  return answer;
}

/// A client's connection: its options, its link, and what came in. Calls (plan, occupancy, status)
/// are functions on it. For one thread.
class Session {
 public:
  explicit Session(ClientOptions options);

  const ClientOptions& options() const { return options_; }
  const wire::Channels& channels() const { return channels_; }
  /// Why the session cannot be used; empty if it can. The status that goes with it.
  const std::string& error() const { return error_; }
  Status error_status() const { return error_status_; }

  using Receiver = std::function<void(std::span<const std::uint8_t>)>;
  /// Who takes the answers on the response channels from now on; must not throw.
  void receive_plan_with(Receiver receiver) { plan_receiver_ = std::move(receiver); }
  void receive_occupancy_with(Receiver receiver) { occupancy_receiver_ = std::move(receiver); }
  void receive_scene_with(Receiver receiver) { scene_receiver_ = std::move(receiver); }
  void receive_upload_with(Receiver receiver) { upload_receiver_ = std::move(receiver); }

  /// A number this client id never used: from the clock, so that it holds across restarts too.
  std::int64_t new_request_id();

  /// For receivers: a new part of the answer came; something else came from the daemon.
  void note_news();
  void note_life();

  /// Asks until `deadline`. `tries` counts up.
  Outcome ask(const Question& question, Clock::time_point deadline, int& tries);

  /// Why there is no answer. `partly` and `fault` may be empty: what came of the answer, and what
  /// was wrong with a message that came on the answer's channel.
  Failure explain(Outcome outcome, std::string_view partly, std::string_view fault) const;

  /// Waits for the next heartbeat.
  DaemonStatus next_heartbeat(Clock::time_point deadline);

 private:
  void listen();
  void take_heartbeat(std::span<const std::uint8_t> bytes);
  std::string where() const;

  ClientOptions options_;
  wire::Channels channels_;
  Link link_;
  std::string error_;
  Status error_status_ = Status::kInvalid;
  std::int64_t last_request_id_ = 0;
  Signs signs_;
  Receiver plan_receiver_;
  Receiver occupancy_receiver_;
  Receiver scene_receiver_;
  Receiver upload_receiver_;
  std::optional<DaemonStatus> heartbeat_;
};

/// The instant so many seconds from now.
Clock::time_point after(double seconds);

// The calls. Preconditions: `session.error()` is empty, nothing else uses the session meanwhile.
PlanResponse ask_plan(Session& session, const PlanRequest& request);
OccupancyAnswer ask_occupancy(Session& session, const OccupancyBatch& batch);

}  // namespace camway
