// SPDX-License-Identifier: MIT
#include "daemon/service/watches/watch_checker.h"

#include <chrono>
#include <utility>

namespace camway::service {
namespace {

using base::Deadline;

/// A path whose check takes longer counts as colliding, so that it does not delay all others.
constexpr double kCheckBudget_s = 1.0;
/// Largest number of verdicts that are reported together, and longest delay of the first of them.
constexpr std::size_t kVerdictsTogether = 64;
constexpr std::chrono::milliseconds kLongestWait{20};

}  // namespace

/// Reports verdicts in groups.
class WatchChecker::Reporter {
 public:
  Reporter(const Report& report, std::string scene, std::uint64_t revision)
      : report_(report), scene_(std::move(scene)), revision_(revision) {}

  void add(Id id, const Collisions& collisions) {
    verdicts_.push_back({id, collisions});
    if (verdicts_.size() >= kVerdictsTogether || Clock::now() - since_ >= kLongestWait) send(false);
  }
  void finish() { send(true); }

 private:
  using Clock = std::chrono::steady_clock;

  void send(bool is_last) {
    report_({scene_, revision_, std::exchange(verdicts_, {}), is_last});
    since_ = Clock::now();
  }

  const Report& report_;
  std::string scene_;
  std::uint64_t revision_;
  std::vector<Verdict> verdicts_;
  Clock::time_point since_ = Clock::now();
};

WatchChecker::WatchChecker(scene::SceneStore& scenes, Report report)
    : scenes_(scenes),
      report_(std::move(report)),
      thread_([this](const std::stop_token& stop) { serve(stop); }) {
  scenes_.on_change([this] {
    {
      const std::lock_guard lock(mutex_);
      has_changed_ = true;
    }
    changed_.notify_one();
  });
}

WatchChecker::~WatchChecker() { scenes_.on_change({}); }

void WatchChecker::post(Task task) {
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  changed_.notify_one();
}

void WatchChecker::watch(Id id, std::string scene,
                         std::shared_ptr<const planning::WatchedPath> path,
                         std::shared_ptr<const scene::Snapshot> proved_in) {
  post([this, id, name = std::move(scene), path = std::move(path),
        proved_in = std::move(proved_in)] { begin(id, name, path, proved_in); });
}

void WatchChecker::forget(Id id, const std::string& scene) {
  post([this, id, scene] {
    const auto position = watched_.find(scene);
    if (position == watched_.end()) return;
    position->second.paths.erase(id);
    if (position->second.paths.empty()) watched_.erase(position);
  });
}

void WatchChecker::serve(const std::stop_token& stop) {
  stop_ = stop;
  while (true) {
    std::vector<Task> tasks;
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [this] { return has_changed_ || !tasks_.empty(); })) return;
      tasks.swap(tasks_);
      has_changed_ = false;
    }
    for (auto& [name, scene] : watched_) update(name, scene);
    for (const Task& task : tasks) task();
  }
}

WatchChecker::Collisions WatchChecker::check(const planning::WatchedPath& path,
                                             const SnapshotPointer& now) const {
  if (!now) return {path.everywhere()};
  return path.collisions(collision::Obstacles(*now),
                         Deadline::after_s(kCheckBudget_s).watched(stop_, nullptr));
}

void WatchChecker::update(const std::string& name, Scene& scene) {
  const SnapshotPointer now = scenes_.find(name);
  if (now == scene.seen) return;
  const bool is_comparable = now && scene.seen;
  const scene::SceneDifference change =
      is_comparable ? scene::difference(*scene.seen, *now) : scene::SceneDifference{};
  Reporter reporter(report_, name, now ? now->revision : 0);
  for (auto& [id, watched] : scene.paths) {
    if (stop_.stop_requested()) return;
    if (is_comparable && !watched.path->may_meet(change)) continue;
    const Deadline budget = Deadline::after_s(kCheckBudget_s).watched(stop_, nullptr);
    const bool was_free = watched.collisions.empty();
    if (is_comparable && was_free && watched.path->stays_free(change, budget)) continue;
    watched.collisions = check(*watched.path, now);
    if (!was_free || !watched.collisions.empty()) reporter.add(id, watched.collisions);
  }
  scene.seen = now;
  reporter.finish();
}

void WatchChecker::begin(Id id, const std::string& name,
                         const std::shared_ptr<const planning::WatchedPath>& path,
                         const SnapshotPointer& proved_in) {
  const auto [position, is_first] = watched_.try_emplace(name);
  Scene& scene = position->second;
  if (is_first) scene.seen = scenes_.find(name);
  Watched watched{path, {}};
  if (!proved_in || scene.seen != proved_in) {
    const bool holds = proved_in && scene.seen &&
                       path->stays_free(scene::difference(*proved_in, *scene.seen),
                                        Deadline::after_s(kCheckBudget_s).watched(stop_, nullptr));
    if (!holds) watched.collisions = check(*path, scene.seen);
  }
  Reporter reporter(report_, name, scene.seen ? scene.seen->revision : 0);
  reporter.add(id, watched.collisions);
  reporter.finish();
  scene.paths.insert_or_assign(id, std::move(watched));
}

}  // namespace camway::service
