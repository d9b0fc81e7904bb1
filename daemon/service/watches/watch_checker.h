// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "daemon/planning/watched_path.h"
#include "daemon/scene/snapshot/scene_store.h"

namespace camway::service {

/// Keeps the collisions of watched paths up to date with their scenes, on a thread of its own.
/// After a change it checks only the differences. A path that was free is checked against the added
/// triangles, if these can be near it. A path that collided is checked from scratch if something
/// near it was added or removed. Changes that arrive faster than they can be checked are checked
/// together. Thread-safe.
class WatchChecker {
 public:
  using Id = std::uint64_t;

  struct Verdict {
    Id id = 0;
    std::vector<collision::CollisionInterval> collisions;  ///< empty exactly if proved free
  };
  /// The results for a revision of a scene.
  struct News {
    std::string scene;
    std::uint64_t revision = 0;  ///< 0: the scene is gone, and all its paths count as colliding
    /// Holds the first verdict on each new path, a verdict on each path that was free and is not
    /// free any more, and a verdict on each path that was not free and was checked again.
    std::vector<Verdict> verdicts;
    /// Whether these are the last news of this revision. Then the earlier verdicts on all other
    /// paths of the scene hold for it, too.
    bool is_last = false;
  };
  /// Called on the checker's thread.
  using Report = std::function<void(News)>;

  /// `scenes` must outlive this, and must have no other listener for changes.
  WatchChecker(scene::SceneStore& scenes, Report report);
  /// Waits for the check that is running.
  ~WatchChecker();
  WatchChecker(const WatchChecker&) = delete;
  WatchChecker& operator=(const WatchChecker&) = delete;

  /// Watches a path, which is proved free in `proved_in`, a revision of its scene. If `proved_in`
  /// is null, nothing is known of the path. Its first verdict follows soon. An id is used only
  /// once.
  void watch(Id id, std::string scene, std::shared_ptr<const planning::WatchedPath> path,
             std::shared_ptr<const scene::Snapshot> proved_in);

  void forget(Id id, const std::string& scene);

 private:
  using SnapshotPointer = std::shared_ptr<const scene::Snapshot>;
  using Collisions = std::vector<collision::CollisionInterval>;
  struct Watched {
    std::shared_ptr<const planning::WatchedPath> path;
    Collisions collisions;  ///< collisions in `Scene::seen`
  };
  struct Scene {
    SnapshotPointer seen;  ///< null: the scene did not exist
    std::map<Id, Watched> paths;
  };
  using Task = std::function<void()>;
  class Reporter;

  void serve(const std::stop_token& stop);
  /// Has the thread run a task.
  void post(Task task);
  /// Checks all paths of a scene for its newest revision.
  void update(const std::string& name, Scene& scene);
  void begin(Id id, const std::string& name,
             const std::shared_ptr<const planning::WatchedPath>& path,
             const SnapshotPointer& proved_in);
  [[nodiscard]] Collisions check(const planning::WatchedPath& path,
                                 const SnapshotPointer& now) const;

  scene::SceneStore& scenes_;
  const Report report_;

  std::mutex mutex_;  ///< guards the next three members
  std::condition_variable_any changed_;
  std::vector<Task> tasks_;
  bool has_changed_ = false;  ///< a scene has changed

  std::map<std::string, Scene> watched_;  ///< used by the thread only
  std::stop_token stop_;                  ///< used by the thread only
  std::jthread thread_;                   ///< last, since it uses all above
};

}  // namespace camway::service
