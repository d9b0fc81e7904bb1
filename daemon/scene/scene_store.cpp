// SPDX-License-Identifier: MIT
#include "daemon/scene/scene_store.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "daemon/scene/occupancy_mirror.h"

namespace camway::scene {

StoreResult SceneStore::over_limit(const Snapshot& next) const {
  const auto over = [&](Limit limit, const std::string& what) {
    return StoreResult{nullptr, StoreFault::kLimit, "scene '" + next.name + "': " + what, limit};
  };
  if (next.objects.size() > limits_.objects) {
    return over(Limit::kObjects, "more than " + std::to_string(limits_.objects) + " objects");
  }
  const std::lock_guard lock(mutex_);
  const auto occupancy_bytes = [](const Snapshot& snapshot) {
    return snapshot.occupancy ? snapshot.occupancy->statistics().memory_bytes : std::uint64_t{0};
  };
  std::uint64_t triangles = next.index.size();
  std::uint64_t bytes = occupancy_bytes(next);
  std::size_t others = 0;
  for (const auto& [name, entry] : scenes_) {
    if (name == next.name) continue;
    ++others;
    triangles += entry.newest->index.size();
    bytes += occupancy_bytes(*entry.newest);
  }
  if (others >= limits_.scenes) {
    return over(Limit::kScenes, "there are " + std::to_string(limits_.scenes) + " scenes already");
  }
  if (triangles > limits_.triangles) {
    return over(Limit::kTriangles, "with it there would be more than " +
                                       std::to_string(limits_.triangles) +
                                       " triangles in all scenes");
  }
  if (bytes > limits_.occupancy_bytes) {
    return over(Limit::kOccupancyBytes,
                "with it the occupancy maps of all scenes would take more than " +
                    std::to_string(limits_.occupancy_bytes) + " bytes");
  }
  return {};
}

StoreResult SceneStore::put(std::shared_ptr<const Snapshot> snapshot) {
  assert(snapshot);
  const std::lock_guard changing(changing_);
  if (StoreResult over = over_limit(*snapshot); over.fault != StoreFault::kNone) return over;
  std::optional<Entry> old;  // takes its time to go, when nobody waits any more
  {
    const std::lock_guard lock(mutex_);
    const auto found = scenes_.find(snapshot->name);
    const std::uint64_t next =
        1 + (found == scenes_.end() ? highest_removed_ : found->second.newest->revision);
    if (snapshot->revision < next) {
      auto numbered = std::make_shared<Snapshot>(*snapshot);
      numbered->revision = next;
      snapshot = std::move(numbered);
    }
    if (found != scenes_.end()) old = std::move(found->second);
    scenes_.insert_or_assign(snapshot->name,
                             Entry{snapshot, SceneHistory(*snapshot, limits_.history)});
  }
  tell();
  return {std::move(snapshot), StoreFault::kNone, ""};
}

StoreResult SceneStore::change(std::string_view scene, SceneChange change) {
  const std::lock_guard changing(changing_);
  const std::shared_ptr<const Snapshot> before = find(scene);
  if (!before) {
    return {nullptr, StoreFault::kUnknownScene,
            "scene: '" + std::string(scene) + "' is unknown; " + summary()};
  }
  SnapshotResult result = changed(*before, change, before->revision + 1);
  if (!result.snapshot) {
    const bool is_limit = result.limit != Limit::kNone;
    return {nullptr, is_limit ? StoreFault::kLimit : StoreFault::kInvalid, std::move(result.error),
            result.limit};
  }
  if (StoreResult over = over_limit(*result.snapshot); over.fault != StoreFault::kNone) return over;
  {
    const std::lock_guard lock(mutex_);
    Entry& entry = scenes_.find(scene)->second;
    entry.newest = result.snapshot;
    entry.history.add(std::move(change), result.snapshot->revision);
    forget_history();
  }
  tell();
  return {std::move(result.snapshot), StoreFault::kNone, ""};
}

void SceneStore::forget_history() {
  std::uint64_t bytes = 0;
  for (const auto& [name, entry] : scenes_) bytes += entry.history.bytes();
  while (bytes > limits_.history.bytes) {
    SceneHistory& longest = std::ranges::max_element(scenes_, {}, [](const auto& scene) {
                              return scene.second.history.bytes();
                            })->second.history;
    bytes -= longest.bytes();
    longest.forget_oldest();
    bytes += longest.bytes();
  }
}

bool SceneStore::remove(std::string_view scene) {
  std::optional<Entry> old;
  const std::lock_guard changing(changing_);
  {
    const std::lock_guard lock(mutex_);
    const auto found = scenes_.find(scene);
    if (found == scenes_.end()) return false;
    highest_removed_ = std::max(highest_removed_, found->second.newest->revision);
    old = std::move(found->second);
    scenes_.erase(found);
  }
  tell();
  return true;
}

void SceneStore::on_change(std::function<void()> listener) {
  const std::lock_guard changing(changing_);
  listener_ = std::move(listener);
}

std::shared_ptr<const Snapshot> SceneStore::find(std::string_view name) const {
  const std::lock_guard lock(mutex_);
  const auto position = scenes_.find(name);
  return position == scenes_.end() ? nullptr : position->second.newest;
}

std::optional<SceneHistory> SceneStore::history(std::string_view name) const {
  const std::lock_guard lock(mutex_);
  const auto position = scenes_.find(name);
  if (position == scenes_.end()) return std::nullopt;
  return position->second.history;
}

std::vector<std::shared_ptr<const Snapshot>> SceneStore::list() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<const Snapshot>> all;
  all.reserve(scenes_.size());
  for (const auto& [name, entry] : scenes_) all.push_back(entry.newest);
  return all;
}

std::string SceneStore::summary() const {
  constexpr std::size_t kShown = 5;
  const std::vector<std::shared_ptr<const Snapshot>> all = list();
  if (all.empty()) return "there are no scenes";
  std::string text = "there are:";
  for (std::size_t i = 0; i < all.size() && i < kShown; ++i) text += " '" + all[i]->name + "'";
  if (all.size() > kShown) text += " and " + std::to_string(all.size() - kShown) + " more";
  return text;
}

}  // namespace camway::scene
