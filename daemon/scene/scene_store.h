// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/scene/limit.h"
#include "daemon/scene/scene_change.h"
#include "daemon/scene/snapshot.h"

namespace camway::scene {

/// What a store holds at most, so that who may change scenes cannot take all memory.
struct SceneStoreLimits {
  std::size_t scenes = 4096;
  std::size_t objects = 4096;            ///< of one scene
  std::uint64_t triangles = 20'000'000;  ///< of all scenes together
  /// Of the occupancy mirrors of all scenes together.
  std::uint64_t occupancy_bytes = std::uint64_t{4} << 30;
  SceneHistory::Limits history;  ///< changes of each scene, bytes of all together
};

/// Why the store refused something.
enum class StoreFault : std::uint8_t { kNone, kUnknownScene, kInvalid, kLimit };

struct StoreResult {
  std::shared_ptr<const Snapshot> snapshot;  ///< the newest now; null on error
  StoreFault fault = StoreFault::kNone;
  std::string error;           ///< empty exactly when `snapshot` is set
  Limit limit = Limit::kNone;  ///< of `StoreFault::kLimit`
};

/// The scenes that a daemon holds, by name: the newest snapshot of each, and how it came to be. A
/// snapshot that someone took stays as it is when its scene changes. The revisions of a name only
/// ever increase, even when its scene is removed and another comes. Safe from any thread; changes
/// are made one after the other, and nobody who only looks waits for them.
class SceneStore {
 public:
  explicit SceneStore(const SceneStoreLimits& limits = {}) : limits_(limits) {}

  /// Adds the scene, or replaces the one of that name; a new history begins. Its revision is that
  /// of the snapshot, or the next that the name has had, whichever is higher.
  StoreResult put(std::shared_ptr<const Snapshot> snapshot);

  /// Changes one object of a scene. Precondition as that of `changed`.
  StoreResult change(std::string_view scene, SceneChange change);

  /// Whether there was such a scene.
  bool remove(std::string_view scene);

  /// Calls `listener` from now on after each change, on the thread of whoever made it; no function
  /// ends that. It must not change scenes. Once this returns the one before is not called any more.
  void on_change(std::function<void()> listener);

  /// The newest snapshot, or null.
  [[nodiscard]] std::shared_ptr<const Snapshot> find(std::string_view name) const;

  /// How the newest snapshot came to be, or nothing if there is no such scene.
  [[nodiscard]] std::optional<SceneHistory> history(std::string_view name) const;

  /// All scenes in order of name.
  [[nodiscard]] std::vector<std::shared_ptr<const Snapshot>> list() const;

  /// For a person who asked for a scene that is not there: the first names, and how many more.
  [[nodiscard]] std::string summary() const;

  [[nodiscard]] const SceneStoreLimits& limits() const { return limits_; }

 private:
  struct Entry {
    std::shared_ptr<const Snapshot> newest;
    SceneHistory history;
  };

  /// What speaks against `next` in the place of the scene of its name; of no fault if nothing does.
  [[nodiscard]] StoreResult over_limit(const Snapshot& next) const;

  /// Shortens the longest histories until all keep to the limit. Precondition: mutex_ is held.
  void forget_history();

  void tell() const {
    if (listener_) listener_();
  }

  const SceneStoreLimits limits_;
  std::mutex changing_;             ///< held by who makes a change, from its beginning to its end
  std::function<void()> listener_;  ///< guarded by changing_
  mutable std::mutex mutex_;        ///< guards all below
  std::map<std::string, Entry, std::less<>> scenes_;
  std::uint64_t highest_removed_ = 0;  ///< revision of the scenes that are gone
};

}  // namespace camway::scene
