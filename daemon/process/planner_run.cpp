// SPDX-License-Identifier: MIT
#include "daemon/process/planner_run.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "daemon/fleet/planner_server.h"
#include "daemon/planning/plan.h"
#include "daemon/process/fleet_member.h"
#include "daemon/process/process_signals.h"
#include "daemon/process/service_manager.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/plans/plan_answerer.h"
#include "daemon/version/build_info.h"

namespace camway::process {
namespace {

constexpr int kExitNoFleet = 1;

/// Lets the main thread wait for the stop of the process. Thread-safe.
class StopWait {
 public:
  void request() {
    {
      const std::lock_guard lock(mutex_);
      is_requested_ = true;
    }
    changed_.notify_all();
  }
  /// Returns whether the stop was requested, after `longest` at the latest.
  bool wait(std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, longest, [this] { return is_requested_; });
  }

 private:
  std::mutex mutex_;  ///< guards is_requested_
  std::condition_variable changed_;
  bool is_requested_ = false;
};

fleet::PlannerOptions planner_options(const DaemonOptions& options, const std::string& id) {
  fleet::PlannerOptions planner;
  planner.fleet = options.fleet.name;
  planner.planner_id = id;
  planner.version = service::version_text();
  planner.workers = options.service.workers;
  return planner;
}

/// Has the server plan until a signal comes.
void plan_until_stopped(fleet::PlannerServer& server, const DaemonOptions& options,
                        service::Log& log) {
  const ServiceManager manager = ServiceManager::from_environment();
  StopWait stop;
  const SignalWaiter signals(
      [&](int signal) {
        log.info("signal", {{"number", signal}});
        stop.request();
      },
      [&] { log.info("a planner has nothing to read again"); });
  log.info("planning", {{"workers", options.service.workers}});
  manager.ready("planning");
  while (!stop.wait(manager.alive_period())) manager.alive();
  manager.stopping();
  if (!server.stop(options.service.drain_limit)) log.warn("stopped while planning");
  log.info("stopped", {{"answers", server.answered()}});
}

}  // namespace

int run_planner(const DaemonOptions& options, const std::shared_ptr<service::Log>& log) {
  block_reload_signal();
  block_stop_signals();
  const std::unique_ptr<FleetMember> member = FleetMember::open_or_log(options, log);
  if (!member) return kExitNoFleet;
  const fleet::PlannerOptions planner = planner_options(options, member->id());
  // An id that was not set is one of this process alone.
  if (!options.fleet.id.empty() && fleet::is_planner_alive(member->connection(), planner)) {
    log->error("another planner of the fleet has this id",
               {{"setting", options.where("fleet.id")}, {"id", planner.planner_id}});
    return kExitNoFleet;
  }
  scene::SceneStore scenes(options.store);
  member->state().scenes().leave_out_mirrors();  // occupancy is asked of fronts
  if (const std::string fault = member->state().load_into(scenes, *log); !fault.empty()) {
    log->error("the scenes of the fleet cannot be read", {{"reason", fault}});
    return kExitNoFleet;
  }
  service::LocalAnswerer answerer(
      [](const scene::Snapshot& snapshot, const planning::PlanRequest& request,
         const base::Deadline& deadline) { return planning::plan(snapshot, request, deadline); },
      options.service.deadline);
  std::atomic<std::uint64_t> position = member->shared_log().followed();
  auto server = fleet::PlannerServer::open(
      {member->connection(), scenes, answerer}, planner,
      [&position] { return static_cast<std::int64_t>(position.load()); }, log);
  if (!server) {
    log->error("no jobs can be taken", {{"reason", server.error}});
    return kExitNoFleet;
  }
  const auto follower =
      member->follow(scenes, options.service.log_limits, [&](std::uint64_t followed) {
        position.store(followed);
        (*server)->position_changed();
      });
  plan_until_stopped(**server, options, *log);
  return EXIT_SUCCESS;
}

}  // namespace camway::process
