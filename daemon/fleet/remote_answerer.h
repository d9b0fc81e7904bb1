// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include <camway/status_t.hpp>

#include "daemon/base/result.h"
#include "daemon/fleet/front_link.h"
#include "daemon/fleet/planner_board.h"
#include "daemon/messages/deadline_limits.h"
#include "daemon/nats/bus.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/plans/plan_answerer.h"

namespace camway::fleet {

/// Configuration of a front.
struct FrontOptions {
  std::string fleet = "camway";  ///< name of the fleet [Limit: is_id(value)]
  std::string front_id;          ///< no other process of the fleet has it [Limit: is_id(value)]
  int workers_here = 1;          ///< requests that the front plans at a time [Limit: 1 <= value]
  messages::DeadlineLimits deadline;  ///< deadlines of plan requests
  /// How long a request waits for a planner that has read the log, before it is planned here.
  std::chrono::milliseconds patience_behind{250};
  /// Time without a word about a job after which it is sent again.
  std::chrono::milliseconds patience_silent{500};
  /// How long after the deadline the planner's answer is waited for.
  std::chrono::milliseconds patience_late{1000};
};

/// Has requests planned by the planners of a fleet, and by `here` where none of them can. A planner
/// that is lost, or does not answer, is replaced by another one. Where two planners answer one
/// request, compares the answers: they depend on the scene and the request only, so a difference
/// raises an alarm (`status_t.differing_answers`).
/// Thread-safe.
class RemoteAnswerer final : public service::PlanAnswerer {
 public:
  /// Returns the position in the log of scenes of the newest change of a scene that this process
  /// has made or read; 0 if none. Called on any thread; must not throw.
  using PositionOf = std::function<std::int64_t(const std::string& scene)>;

  /// The objects that a front uses. All must outlive it.
  struct Parts {
    nats::Bus& bus;
    PlannerBoard& board;
    const scene::SceneStore& scenes;
    service::PlanAnswerer& here;  ///< plans in this process
  };

  /// Fails if the bus takes no subscription, or for names that are none.
  static base::Result<std::unique_ptr<RemoteAnswerer>> open(
      const Parts& parts, const FrontOptions& options, PositionOf position_of,
      const std::shared_ptr<service::Log>& log);
  /// Requires that no call of `answer` runs.
  ~RemoteAnswerer() override;

  /// Returns at the deadline, or `FrontOptions::patience_late` after it if a planner has the job.
  service::Answered answer(const std::shared_ptr<const scene::Snapshot>& snapshot,
                           const plan_request_t& request, const base::Deadline& deadline) override;

  /// As in `FrontLink`.
  bool claim_id() { return link_.claim_id(); }
  void leave_id() { link_.leave_id(); }

  /// Takes in that the bus was lost or made again, for the log.
  /// Thread-safe.
  void connection_changed(bool is_connected) { link_.connection_changed(is_connected); }

  [[nodiscard]] FrontCounts counts() const { return link_.counts(); }

  /// Adds the fleet to a status: role, counts and planners. `newest`: the position of the log that
  /// this process has read; `is_in_touch`: whether it can reach the log.
  void add_to(status_t& status, std::int64_t newest, bool is_in_touch) const;

 private:
  friend class RemoteJob;

  RemoteAnswerer(const Parts& parts, const FrontOptions& options, PositionOf position_of,
                 const std::shared_ptr<service::Log>& log);

  /// Takes a place among the requests that are planned here; returns false if there is none.
  bool take_place_here();
  void give_place_back() { --planning_here_; }

  const Parts parts_;
  const FrontOptions options_;
  const PositionOf position_of_;
  std::atomic<int> planning_here_ = 0;
  FrontLink link_;
  std::jthread keeper_;  ///< ticks the board; last, since it uses all above
};

}  // namespace camway::fleet
