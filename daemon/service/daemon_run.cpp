// SPDX-License-Identifier: MIT
#include "daemon/service/daemon_run.h"

#include <cstdlib>

#include "daemon/planning/plan.h"
#include "daemon/scene/import_warnings.h"
#include "daemon/scene/occupancy_mirror.h"
#include "daemon/service/lcm_transport.h"
#include "daemon/service/service.h"
#include "daemon/service/stop_signals.h"

namespace camway::service {
namespace {

constexpr int kExitLcm = 1;

void log_scene(const scene::Snapshot& snapshot, const SceneArgument& scene, spdlog::logger& log) {
  const scene::ImportReport& report = snapshot.report;
  const geometry::Box& box = report.bounds_m;
  log.info(
      "scene {} from {}: {}, {} triangles, bounds ({:.3g}, {:.3g}, {:.3g}) to ({:.3g}, {:.3g}, "
      "{:.3g}) m at scale {:g}, rounded by {:.2g} m at most, {} degenerate and {} bad triangles "
      "left "
      "out, digest {}",
      snapshot.name, scene.file.string(), report.format, report.triangles, box.min().x(),
      box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z(), report.scale,
      report.rounding_m, report.degenerate_triangles,
      report.dropped_nonfinite + report.dropped_bad_index, snapshot.digest);
  for (const std::string& warning :
       scene::import_warnings(report, planning::PlanOptions{}.interval_tolerance_m)) {
    log.warn("scene {}: {}", snapshot.name, warning);
  }
  if (snapshot.occupancy) {
    log.info("scene {}: occupancy map of {} voxels at {:g} m", snapshot.name,
             snapshot.occupancy->statistics().occupied_voxels, snapshot.occupancy->resolution_m());
  }
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

bool load_scenes(const DaemonOptions& options, scene::SceneStore& store, spdlog::logger& log) {
  for (const SceneArgument& scene : options.scenes) {
    scene::SnapshotResult loaded = scene::load_snapshot(scene.name, scene.file, scene.options);
    if (!loaded.snapshot) {
      log.error("scene {}: {}", scene.name, loaded.error);
      return false;
    }
    log_scene(*loaded.snapshot, scene, log);
    store.put(std::move(loaded.snapshot));
  }
  return true;
}

int serve(const DaemonOptions& options, const scene::SceneStore& scenes,
          const std::shared_ptr<spdlog::logger>& log) {
  const OpenedTransport opened = open_lcm_transport(options.lcm_url);
  if (!opened.transport) {
    log->error(opened.error);
    return kExitLcm;
  }
  const Planner planner = [](const scene::Snapshot& snapshot, const planning::PlanRequest& request,
                             const collision::Deadline& deadline) {
    return planning::plan(snapshot, request, deadline);
  };
  Service service(*opened.transport, scenes, options.service, planner, log);
  log->info("serving on {} with prefix {}, {} workers, queue of {}, {} for a client",
            options.lcm_url, options.service.prefix, options.service.workers,
            options.service.queue.jobs, options.service.queue.jobs_of_a_client);
  const StopSignals stop_signals([&](int signal) {
    log->info("signal {}", signal);
    service.request_stop();
  });
  return exit_code_of(service.run(), options.lcm_url, *log);
}

}  // namespace camway::service
