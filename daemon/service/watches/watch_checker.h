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

/// Keeps what is known of watched paths true to their scenes, on a thread of its own. Of a change
/// it looks only at what is different: a path that was free is asked about what was added alone,
/// where that can be near; one that collided is checked from scratch if something comes or goes
/// near it. Changes that come faster than they can be looked at are looked at together. All members
/// may be called from any thread.
class WatchChecker {
 public:
  using Id = std::uint64_t;

  struct Verdict {
    Id id = 0;
    std::vector<collision::CollisionInterval> collisions;  ///< empty exactly if proved free
  };
  /// What is known at a revision of a scene.
  struct News {
    std::string scene;
    std::uint64_t revision = 0;  ///< 0: the scene is gone, and all its paths count as colliding
    /// The first of each path, and those that are new: of paths that were free and are not, and of
    /// all that were not free and were checked again.
    std::vector<Verdict> verdicts;
    /// The last of this revision: what is known of all other paths of the scene holds for it too.
    bool is_last = false;
  };
  /// Called on the checker's thread.
  using Tell = std::function<void(News)>;

  /// `scenes` must outlive this, which listens to its changes; nobody else may.
  WatchChecker(scene::SceneStore& scenes, Tell tell);
  /// Waits for the path that is being checked.
  ~WatchChecker();
  WatchChecker(const WatchChecker&) = delete;
  WatchChecker& operator=(const WatchChecker&) = delete;

  /// From now on that path is watched; its first verdict comes soon. It is proved free in
  /// `proved_in`, a revision of that scene. An id is used once.
  void watch(Id id, std::string scene, std::shared_ptr<const planning::WatchedPath> path,
             std::shared_ptr<const scene::Snapshot> proved_in);

  void forget(Id id, const std::string& scene);

 private:
  using SnapshotPointer = std::shared_ptr<const scene::Snapshot>;
  using Collisions = std::vector<collision::CollisionInterval>;
  struct Watched {
    std::shared_ptr<const planning::WatchedPath> path;
    Collisions collisions;  ///< in `Scene::seen`
  };
  struct Scene {
    SnapshotPointer seen;  ///< null: it was not there
    std::map<Id, Watched> paths;
  };
  class Teller;

  void serve(const std::stop_token& stop);
  void order(std::function<void()> order);
  /// Brings all paths of a scene to its newest revision.
  void update(const std::string& name, Scene& scene);
  void begin(Id id, const std::string& name,
             const std::shared_ptr<const planning::WatchedPath>& path,
             const SnapshotPointer& proved_in);
  [[nodiscard]] Collisions check(const planning::WatchedPath& path,
                                 const SnapshotPointer& now) const;

  scene::SceneStore& scenes_;
  const Tell tell_;

  std::mutex mutex_;  ///< guards the next three
  std::condition_variable_any changed_;
  std::vector<std::function<void()>> orders_;
  bool has_changed_ = false;  ///< some scene

  std::map<std::string, Scene> watched_;  ///< the thread's own
  std::stop_token stop_;                  ///< likewise
  std::jthread thread_;                   ///< last: uses all above
};

}  // namespace camway::service
