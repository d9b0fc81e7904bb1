// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
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
  kDrained,    ///< stopped on request; everything that was being planned was answered
  kAbandoned,  ///< stopped on request, but threads still plan, or change a scene, without an answer
  kPrefixTaken,     ///< another daemon serves with the prefix, which was logged
  kNotSubscribed,   ///< the transport refused a subscription; nothing was served
  kTransportBroken  ///< the transport failed while serving
};

/// Callbacks of the process around the service. Called on the loop thread; empty ones are skipped.
struct ServiceHooks {
  std::function<void()> ready;     ///< subscriptions are in place, and the first status was sent
  std::function<void()> stopping;  ///< a stop was requested
  /// Called with each status before it is published, to complete or to keep it.
  std::function<void(status_t&)> status;
  /// Called every `alive_period`, as long as the loop runs and no worker has been at one request
  /// for longer than the longest deadline plus `stuck_after`.
  std::function<void()> alive;
  std::chrono::milliseconds alive_period{1000};
  /// Time beyond the longest deadline after which a worker counts as stuck. It is long because
  /// planning checks its deadline only now and then, and more rarely on a busy machine.
  std::chrono::milliseconds stuck_after{60'000};
};

/// The daemon without its process. One thread, the caller of `run`, owns the transport, checks and
/// queues requests and publishes answers; a fixed number of workers plan on immutable snapshots, or
/// wait for other processes that do.
class Service {
 public:
  /// `transport` and `scenes` must outlive the service. Requires that `config` keeps its limits.
  /// `answerer` is not null.
  Service(Transport& transport, scene::SceneStore& scenes, const ServiceConfig& config,
          std::shared_ptr<PlanAnswerer> answerer, std::shared_ptr<Log> log,
          ServiceHooks hooks = {});
  /// Plans in this process.
  Service(Transport& transport, scene::SceneStore& scenes, const ServiceConfig& config,
          Planner planner, std::shared_ptr<Log> log, ServiceHooks hooks = {});
  /// Waits for planning that is still running; its results are not sent.
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// Asks whether another daemon has the prefix, as `run` does again: to be called before anything
  /// is changed that daemons share. Returns the outcome of a run that cannot begin; nothing if none
  /// has it.
  std::optional<RunOutcome> look_for_rival();

  /// Serves until `request_stop`, unless another daemon has the prefix
  /// (`CoreConfig::claim_window`). Logs "ready" and publishes a first status when subscriptions are
  /// in place. Call it once only.
  RunOutcome run();

  /// Begins the stop. Planning that is running is finished and answered, within the drain limit;
  /// requests that wait or still arrive are answered with `overloaded`, changes of scenes with
  /// `stopping`.
  /// Thread-safe.
  void request_stop() noexcept;

  /// Sets how many requests may be planned at a time from now on, `CoreConfig::workers` at first.
  /// Other values count as the nearest possible one.
  /// Thread-safe. [Limit: 1 <= jobs <= CoreConfig::most_jobs]
  void allow(int jobs) { core_.workers.allow(jobs); }

 private:
  using Clock = std::chrono::steady_clock;

  bool listen_for_claims();
  void ask_for_rivals();
  RunOutcome yield();
  bool subscribe();
  void run_round(Clock::duration longest_wait);
  RunOutcome drain();
  void heartbeat(Clock::time_point now);
  void tell_alive(Clock::time_point now);
  [[nodiscard]] bool idle() const;
  [[nodiscard]] std::function<void(std::span<const std::uint8_t>)> guarded(
      std::function<void(std::span<const std::uint8_t>)> handler, std::string channel);

  const ServiceHooks hooks_;
  const double longest_deadline_s_;  ///< longest deadline of a plan request
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
  bool hears_claims_ = false;
  bool broken_ = false;
};

}  // namespace camway::service
