// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/scene/mesh/resource_limit.h"
#include "daemon/scene/snapshot/change_ticket.h"
#include "daemon/scene/snapshot/scene_change.h"
#include "daemon/scene/snapshot/snapshot.h"

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
enum class StoreFault : std::uint8_t { kNone, kUnknownScene, kInvalid, kLimit, kCalledOff };

struct StoreResult {
  std::shared_ptr<const Snapshot> snapshot;  ///< the newest now; null on error
  StoreFault fault = StoreFault::kNone;
  std::string error;           ///< empty exactly when `snapshot` is set
  Limit limit = Limit::kNone;  ///< of `StoreFault::kLimit`
};

/// The scenes that a daemon holds, by name: the newest snapshot of each, and how it came to be. A
/// snapshot that someone took stays as it is when its scene changes. The revisions of a name only
/// ever increase, even when its scene is removed and another comes.
///
/// Safe from any thread. Changes of one scene are made one after the other, those of different ones
/// side by side: each holds the turn of its scene from its beginning to its end, and what all wait
/// for, who only looks included, no longer than it takes to put the finished snapshot in its place.
/// What all scenes together come to is looked at there, too, so no limit is ever broken; what is
/// being made is not counted yet. What is called off before (`Undertaking`) changes nothing.
class SceneStore {
 public:
  explicit SceneStore(const SceneStoreLimits& limits = {}) : limits_(limits) {}

  /// Adds the scene, or replaces the one of that name; a new history begins. Its revision is that
  /// of the snapshot, or the next that the name has had, whichever is higher.
  StoreResult put(std::shared_ptr<const Snapshot> snapshot, ChangeNote note = {},
                  const Undertaking& undertaking = {});

  /// Changes one object of a scene. Precondition as that of `changed`.
  StoreResult change(std::string_view scene, SceneChange change, ChangeNote note = {},
                     const Undertaking& undertaking = {});

  /// Makes a new revision with the objects of one that is kept. If it is not, the error says which
  /// are.
  StoreResult restore(std::string_view scene, std::uint64_t revision, ChangeNote note = {},
                      const Undertaking& undertaking = {});

  /// Makes a scene `other` of them, or replaces the one of that name; as `put`.
  StoreResult restore_as(std::string_view scene, std::uint64_t revision, std::string other,
                         ChangeNote note = {}, const Undertaking& undertaking = {});

  /// Whether there was such a scene; false, too, if it was called off.
  bool remove(std::string_view scene, const Undertaking& undertaking = {});

  /// Calls `listener` from now on after each change, on the thread of whoever made it, but never on
  /// two at a time; no function ends that. It must not change scenes. Once this returns the one
  /// before is not called any more.
  void on_change(std::function<void()> listener);

  /// The newest snapshot, or null.
  [[nodiscard]] std::shared_ptr<const Snapshot> find(std::string_view name) const;

  /// How the newest snapshot came to be, or nothing if there is no such scene.
  [[nodiscard]] std::optional<SceneHistory> history(std::string_view name) const;

  /// The newest snapshot, and all revisions that can be restored, oldest first; the last is the
  /// newest. Empty and null if there is no such scene.
  struct Kept {
    std::shared_ptr<const Snapshot> newest;
    std::vector<KeptRevision> revisions;
  };
  [[nodiscard]] Kept kept(std::string_view name) const;

  /// All scenes in order of name.
  [[nodiscard]] std::vector<std::shared_ptr<const Snapshot>> list() const;

  /// For a person who asked for a scene that is not there: the first names, and how many more.
  [[nodiscard]] std::string summary() const;

  [[nodiscard]] const SceneStoreLimits& limits() const { return limits_; }

 private:
  /// What counts of a scene, or of all together.
  struct Load {
    std::uint64_t triangles = 0;
    std::uint64_t occupancy_bytes = 0;
  };
  struct Entry {
    std::shared_ptr<const Snapshot> newest;
    Load load;
    SceneHistory history;
  };
  using Scenes = std::map<std::string, Entry, std::less<>>;

  /// Nobody else changes the scene of that name, which may not be there, while this lives.
  class Turn {
   public:
    Turn(SceneStore& store, std::string_view scene);
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    SceneStore& store_;
    std::set<std::string, std::less<>>::iterator scene_;
  };

  static Load load_of(const Snapshot& snapshot);
  [[nodiscard]] StoreResult unknown(std::string_view scene) const;
  /// Precondition: it is the scene's turn, and `before` is its newest.
  StoreResult make_next(const Snapshot& before, SceneChanges changes, ChangeNote note,
                        const Undertaking& undertaking);

  /// The lowest revision that the next scene of that name may have. Stays true while its turn
  /// lasts.
  [[nodiscard]] std::uint64_t next_revision(std::string_view scene) const;

  /// What speaks against `next` in the place of the scene of its name; of no fault if nothing
  /// does. Precondition of this and the next two: mutex_ is held.
  [[nodiscard]] StoreResult over_limit(const Snapshot& next, const Load& load) const;
  /// Counts a scene of that load, or of none, in the place of the one that is there, or of none.
  void count(const Load& before, const Load& after);
  /// Shortens the longest histories until all keep to the limit.
  void forget_history();

  void tell();

  const SceneStoreLimits limits_;
  std::mutex telling_;              ///< held while the listener is called; before mutex_
  std::function<void()> listener_;  ///< guarded by telling_
  mutable std::mutex mutex_;        ///< guards all below; held for moments only
  std::condition_variable turn_ended_;
  std::set<std::string, std::less<>> changing_;  ///< scenes of which it is somebody's turn
  Scenes scenes_;
  Load total_;                         ///< of `scenes_`
  std::uint64_t highest_removed_ = 0;  ///< revision of the scenes that are gone
};

}  // namespace camway::scene
