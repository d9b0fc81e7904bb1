// SPDX-License-Identifier: MIT
#include "tools/camway/load/load_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/base/result.h"

namespace camway::tools {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Samples a process's memory on a thread of its own during the object's lifetime.
class MemoryWatch {
 public:
  MemoryWatch(int pid, double period_s) {
    if (pid == 0) return;
    thread_ = std::jthread([this, pid, period_s](const std::stop_token& stop) {
      const Clock::time_point start = Clock::now();
      while (!stop.stop_requested()) {
        samples_.push_back({seconds_since(start), resident_mb(pid)});
        std::this_thread::sleep_for(std::chrono::duration<double>(period_s));
      }
    });
  }

  std::vector<MemorySample> finish() {
    if (thread_.joinable()) {
      thread_.request_stop();
      thread_.join();
    }
    return std::move(samples_);
  }

 private:
  std::vector<MemorySample> samples_;
  std::jthread thread_;
};

/// Returns the sampling period: short enough for short runs, and long enough to be cheap in long
/// ones.
double memory_period_s(double seconds) { return std::clamp(seconds / 200.0, 0.05, 5.0); }

/// A planner that was not heard for so long has none of the load.
constexpr double kSilentPlanner_s = 1.0;

void count_planners(const DaemonStatus& status, LoadResult& result) {
  for (const FleetPlanner& planner : status.planners) {
    if (planner.silent_s > kSilentPlanner_s) continue;
    ++result.planners;
    result.planner_slots += planner.workers;
  }
}

}  // namespace

base::Result<Clients> make_clients(const LoadOptions& options) {
  Clients clients;
  for (int i = 0; i < options.clients; ++i) {
    ClientOptions client;
    client.url = options.url;
    client.prefix = options.prefix;
    client.authentication = options.authentication;
    clients.push_back(std::make_unique<Client>(client));
    if (!clients.back()->good()) return base::Failure{clients.back()->error()};
  }
  return clients;
}

LoadFault fault_of_daemon(Client& client, const LoadScene& scene) {
  if (const DaemonStatus status = client.status(); !status.ok()) {
    return {status.status, status.error};
  }
  const SceneAnswer held = client.describe_scene(scene.name);
  if (!held.ok()) return {held.status, held.error};
  if (held.scene.digest == scene.digest) return {};
  return {Status::kInvalid,
          fmt::format("the daemon's scene '{}' (digest {}, revision {}) is not the one of --scene "
                      "(digest {}): its file or scale differ, or it was changed since; nothing was "
                      "asked",
                      scene.name, held.scene.digest, held.scene.revision, scene.digest)};
}

LoadResult run_load(const LoadScene& scene, const std::vector<LoadRequest>& requests,
                    const LoadOptions& options) {
  LoadResult result;
  base::Result<Clients> made = make_clients(options);
  if (!made) {
    result.error = std::move(made.error);
    return result;
  }
  const Clients& clients = *made;
  if (LoadFault fault = fault_of_daemon(*clients.front(), scene); fault.status != Status::kOk) {
    result.error = std::move(fault.error);
    result.status = fault.status;
    return result;
  }
  MemoryWatch memory(options.daemon_pid, memory_period_s(options.seconds));
  std::vector<LoadTally> tallies(clients.size());
  std::atomic<std::int64_t> begun = 0;
  const Clock::time_point start = Clock::now();
  const auto work = [&](std::size_t number) {
    for (std::size_t turn = number; seconds_since(start) < options.seconds; ++turn) {
      if (options.requests > 0 && begun.fetch_add(1) >= options.requests) return;
      const LoadRequest& sent = requests[turn % requests.size()];
      tallies[number].add(sent, clients[number]->plan(sent.request));
    }
  };
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < clients.size(); ++i) threads.emplace_back(work, i);
  }
  result.elapsed_s = seconds_since(start);
  result.memory = memory.finish();
  for (const LoadTally& tally : tallies) result.tally.add(tally);
  count_planners(clients.front()->status(), result);
  return result;
}

}  // namespace camway::tools
