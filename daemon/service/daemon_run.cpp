// SPDX-License-Identifier: MIT
#include "daemon/service/daemon_run.h"

#include <cstdlib>
#include <mutex>
#include <utility>

#include "daemon/planning/plan.h"
#include "daemon/service/lcm_transport.h"
#include "daemon/service/metrics_text.h"
#include "daemon/service/process_signals.h"
#include "daemon/service/service.h"
#include "daemon/service/service_manager.h"

namespace camway::service {
namespace {

constexpr int kExitLcm = 1;
constexpr int kExitMetrics = 1;

/// The last status, between the loop that makes it and the page that shows it.
class LatestStatus {
 public:
  void set(const status_t& status) {
    const std::lock_guard lock(mutex_);
    status_ = status;
  }
  [[nodiscard]] status_t get() const {
    const std::lock_guard lock(mutex_);
    return status_;
  }

 private:
  mutable std::mutex mutex_;  ///< guards status_
  status_t status_{};
};

/// The page for Prometheus, if one is asked for.
OpenedHttpPage open_metrics(const HttpAddress& address, const LatestStatus& latest) {
  if (address.port == 0) return {};
  return open_http_page(address, "/metrics", "text/plain; version=0.0.4; charset=utf-8",
                        [&latest] { return metrics_text(latest.get()); });
}

/// What the outcome of a run means for the process.
int exit_code_of(RunOutcome outcome, const std::string& url, spdlog::logger& log) {
  switch (outcome) {
    case RunOutcome::kDrained:
      return EXIT_SUCCESS;
    case RunOutcome::kAbandoned:
      log.flush();
      std::_Exit(EXIT_SUCCESS);
    case RunOutcome::kNotSubscribed:
      log.error("LCM takes no subscription at '{}'. {}", url, multicast_hint());
      return kExitLcm;
    case RunOutcome::kTransportBroken:
      log.error("LCM at '{}' failed", url);
      return kExitLcm;
  }
  return kExitLcm;
}

}  // namespace

int serve(const DaemonOptions& options, Reloader::Read read_again, scene::SceneStore& scenes,
          ConfiguredScenes& configured, const std::shared_ptr<spdlog::logger>& log) {
  const OpenedTransport opened = open_lcm_transport(options.lcm_url);
  if (!opened.transport) {
    log->error(opened.error);
    return kExitLcm;
  }
  LatestStatus latest;
  const OpenedHttpPage metrics = open_metrics(options.metrics, latest);
  if (!metrics.error.empty()) {
    log->error("metrics: {}", metrics.error);
    return kExitMetrics;
  }
  const ServiceManager manager = ServiceManager::from_environment();
  ServiceHooks hooks;
  hooks.ready = [&] { manager.ready("serving"); };
  hooks.stopping = [&] { manager.stopping(); };
  hooks.alive = [&] { manager.alive(); };
  if (metrics.page) {
    log->info("metrics at http://{}:{}/metrics", options.metrics.ip, metrics.page->port());
    hooks.status = [&](const status_t& status) { latest.set(status); };
  }
  hooks.alive_period = manager.alive_period();
  const Planner planner = [](const scene::Snapshot& snapshot, const planning::PlanRequest& request,
                             const collision::Deadline& deadline) {
    return planning::plan(snapshot, request, deadline);
  };
  Service service(*opened.transport, scenes, options.service, planner, log, std::move(hooks));
  log->info("serving on {} with prefix {}, {} workers, queue of {}, {} for a client",
            options.lcm_url, options.service.prefix, options.service.workers,
            options.service.queue.jobs, options.service.queue.jobs_of_a_client);
  Reloader reloader(options, std::move(read_again), configured, manager, log);
  const SignalWaiter signals(
      [&](int signal) {
        log->info("signal {}", signal);
        service.request_stop();
      },
      [&] { reloader.request(); });
  return exit_code_of(service.run(), options.lcm_url, *log);
}

}  // namespace camway::service
