// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include <camway/status_t.hpp>

#include "daemon/service/core/core.h"
#include "daemon/service/occupancy/occupancy_service.h"
#include "daemon/service/plans/plan_service.h"
#include "daemon/service/prefix_claim.h"
#include "daemon/service/scenes/scene_service.h"
#include "daemon/service/service_config.h"
#include "daemon/service/transport/transport.h"
#include "daemon/service/watches/watches.h"

namespace camway::service {

/// How a run of the service ended.
enum class RunOutcome {
  kDrained,         ///< stopped on request, everything that was being planned was answered
  kAbandoned,       ///< the same, but threads still plan, or change a scene, for nobody
  kPrefixTaken,     ///< another daemon serves with the prefix, which was logged
  kNotSubscribed,   ///< the transport took no subscription; nothing was served
  kTransportBroken  ///< the transport failed while serving
};

/// What the process around the service wants to know of it. Called by the loop thread; what is
/// empty is left out.
struct ServiceHooks {
  std::function<void()> ready;     ///< subscriptions are in place, the first status is out
  std::function<void()> stopping;  ///< a stop was asked for
  /// Each status before it is published, to add to it what the service does not know, or to keep.
  std::function<void(status_t&)> status;
  /// Every `alive_period`, as long as the loop turns and no worker has been at one request for
  /// longer than the longest deadline and `stuck_after`.
  std::function<void()> alive;
  std::chrono::milliseconds alive_period{1000};
  /// Planning looks at its deadline now and then, and a busy machine makes that rare.
  std::chrono::milliseconds stuck_after{60'000};
};

/// The daemon without its process: one thread, the caller of `run`, owns the transport, checks and
/// queues requests and publishes answers; a fixed number of workers plan on immutable snapshots.
class Service {
 public:
  /// `transport` and `scenes` must outlive the service. Precondition: `config` keeps its limits.
  Service(Transport& transport, scene::SceneStore& scenes, const ServiceConfig& config,
          Planner planner, std::shared_ptr<Log> log, ServiceHooks hooks = {});
  /// Waits for what is still being planned, which it does not answer any more.
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// Serves until `request_stop`, unless another daemon does: see `ServiceConfig::claim_window`.
  /// Logs "ready" and publishes a first status when subscriptions are in place. To be called once.
  RunOutcome run();

  /// From any thread: begins the stop. What is being planned is finished and answered, within the
  /// drain limit; what waits, and what still comes in, is answered with `overloaded`.
  void request_stop() noexcept;

 private:
  using Clock = std::chrono::steady_clock;

  bool claim_prefix();
  RunOutcome yield();
  bool subscribe();
  void turn(Clock::duration longest_wait);
  RunOutcome drain();
  void heartbeat(Clock::time_point now);
  void tell_alive(Clock::time_point now);
  [[nodiscard]] bool idle() const;
  [[nodiscard]] std::function<void(std::span<const std::uint8_t>)> guarded(
      std::function<void(std::span<const std::uint8_t>)> handler, std::string channel);

  const ServiceHooks hooks_;
  const double longest_deadline_s_;  ///< of a plan request
  Core core_;
  PrefixClaim claim_;
  Watches watches_;
  PlanService plans_;
  OccupancyService occupancy_;
  SceneService scenes_;
  const Clock::time_point started_ = Clock::now();
  Clock::time_point next_heartbeat_ = started_;
  Clock::time_point next_alive_ = started_;
  std::atomic<bool> stop_ = false;
  bool broken_ = false;
};

}  // namespace camway::service
