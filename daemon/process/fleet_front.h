// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include <camway/status_t.hpp>

#include "daemon/fleet/planner_board.h"
#include "daemon/fleet/remote_answerer.h"
#include "daemon/process/fleet_member.h"
#include "daemon/process/settings/daemon_options.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/log/log.h"
#include "daemon/service/plans/plan_answerer.h"
#include "daemon/service/service.h"

namespace camway::process {

/// The planners of a front. Not thread-safe, except for what `answerer` returns.
class FleetFront {
 public:
  /// Lets requests be planned by the planners of the fleet, or by `here` where none of them can.
  /// `member`, `scenes` and `here` must outlive it. Logs the reason and returns null if that is not
  /// possible.
  static std::unique_ptr<FleetFront> open_or_log(const DaemonOptions& options, FleetMember& member,
                                                 const scene::SceneStore& scenes,
                                                 service::PlanAnswerer& here,
                                                 const std::shared_ptr<service::Log>& log);

  [[nodiscard]] std::shared_ptr<service::PlanAnswerer> answerer() { return answerer_; }

  /// Lets the service plan as much at a time as planners can, or else this process, from now on.
  void feed(service::Service& service);
  /// Ends that; before the service is destroyed.
  void stop_feeding() { board_.on_change({}); }

  /// Claims the id of this front. Logs it and returns false if another one that is alive has it.
  /// To be called before any scene of the fleet is changed.
  bool claim_id_or_log(const DaemonOptions& options, service::Log& log);
  /// Lets another front take the id of this one, which ends.
  void leave() { answerer_->leave_id(); }

  void add_to(status_t& status) const;

 private:
  FleetFront(FleetMember& member, int workers);

  FleetMember& member_;
  const int workers_;
  fleet::PlannerBoard board_;
  std::shared_ptr<fleet::RemoteAnswerer> answerer_;
};

}  // namespace camway::process
