// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "daemon/scene/snapshot/scene_object.h"
#include "daemon/scene/snapshot/snapshot.h"

namespace camway::scene {

/// One change of a scene.
struct SceneChange {
  enum class Kind : std::uint8_t {
    kPut,   ///< adds the object, or replaces the one of that name
    kMove,  ///< changes the placement of the object
    kRemove,
  };

  Kind kind = Kind::kPut;
  std::string object;
  std::shared_ptr<const ObjectSource> source;  ///< set for kPut
  Placement placement;                         ///< for kPut and kMove
};

/// Changes that take effect together, made in this order.
using SceneChanges = std::vector<SceneChange>;

/// The scene after `changes`, which builds again only what they change. Fails, with an error that
/// names the object, if the object does not exist or cannot be placed there, or if a stop is
/// requested, as in `place_object`. Requires a source where the kind needs one. The two snapshots
/// are independent.
/// Thread-safe.
SnapshotResult changed(const Snapshot& before, const SceneChanges& changes, std::uint64_t revision,
                       const std::stop_token& stop = {});
SnapshotResult changed(const Snapshot& before, const SceneChange& change, std::uint64_t revision,
                       const std::stop_token& stop = {});

/// A record of a change for people who look for a revision.
struct ChangeNote {
  std::string operation = {};           ///< word for the operation: "load", "move" and so on
  std::string object = {};              ///< changed object; empty: all
  std::string client = {};              ///< client that asked for it; empty: none
  std::uint64_t restored_revision = 0;  ///< revision whose objects were restored; 0: none
  std::chrono::system_clock::time_point when = {};  ///< set by the store
  /// Names the request, if it may be repeated: equal for repetitions of one request only. Empty:
  /// none.
  std::string request = {};
};

/// A revision that can be rebuilt, and the change that led to it.
struct KeptRevision {
  std::uint64_t revision = 0;
  ChangeNote note = {};
};

/// An object as a history keeps it.
struct PlacedSource {
  std::string name;
  std::shared_ptr<const ObjectSource> source;
  Placement placement;
};

/// The objects of a snapshot, in their order.
std::vector<PlacedSource> placed_sources_of(const Snapshot& snapshot);

/// The latest changes of a scene, as many as the limits allow, and its objects before them, from
/// which these revisions can be rebuilt. A value type.
class SceneHistory {
 public:
  struct Limits {
    std::size_t changes = 1024;
    /// Limit of `SceneHistory::bytes`.
    std::uint64_t bytes = std::uint64_t{256} << 20;
  };
  struct Entry {
    KeptRevision made;  ///< revision after the changes
    SceneChanges changes;
    std::uint64_t bytes = 0;  ///< memory of the new sources that their predecessors lack
  };

  /// A history that begins with `first`.
  SceneHistory(const Snapshot& first, const Limits& limits, ChangeNote note = {});

  /// A history that begins with these objects at revision `oldest`. Requires objects in the order
  /// of their names, each once, with sources that were built with `options`.
  SceneHistory(std::string name, const ObjectOptions& options,
               const std::vector<PlacedSource>& objects, KeptRevision oldest, const Limits& limits);

  /// Requires that `changed`, with `changes`, made `made.revision` from the newest revision.
  void add(SceneChanges changes, KeptRevision made);

  /// Approximate memory that is kept for earlier revisions only. Memory that the source of an
  /// object shares with its predecessor, as an occupancy map does after a scan, counts once; a
  /// source that was removed and came back counts twice. Above 0 only if there is a change.
  [[nodiscard]] std::uint64_t bytes() const;
  /// Requires that there is a change.
  void forget_oldest();

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t newest_revision() const {
    return entries_.empty() ? oldest_.revision : entries_.back().made.revision;
  }
  /// Returns whether a kept change was made by the request that `ChangeNote::request` names.
  [[nodiscard]] bool has_request(const std::string& request) const;

  /// The revision before the oldest change that is kept.
  [[nodiscard]] std::uint64_t oldest_revision() const { return oldest_.revision; }
  [[nodiscard]] const std::deque<Entry>& entries() const { return entries_; }
  /// All revisions that can be rebuilt, oldest first.
  [[nodiscard]] std::vector<KeptRevision> revisions() const;

  /// Rebuilds a revision from the sources and placements of its objects: equal to the original in
  /// everything. Returns null if `revision` is not kept, if an object cannot be placed where it is
  /// said to be, or if a stop is requested.
  [[nodiscard]] std::shared_ptr<const Snapshot> rebuild(std::uint64_t revision,
                                                        const std::stop_token& stop = {}) const;

  /// The changes that turn the newest revision into `revision`: the same objects in the same
  /// places. Returns nothing if `revision` is not kept.
  [[nodiscard]] std::optional<SceneChanges> changes_back_to(std::uint64_t revision) const;

 private:
  struct Placed {
    std::shared_ptr<const ObjectSource> source;
    Placement placement;
  };
  struct State {
    std::map<std::string, Placed, std::less<>> objects;
    std::uint64_t bytes = 0;  ///< memory of the objects' sources

    void put(std::string_view name, const Placed& placed);
    void remove(std::string_view name);
    void apply(const SceneChange& change);
    void apply(const SceneChanges& changes);
  };

  /// Memory of the change's source that the newest revision does not have.
  [[nodiscard]] std::uint64_t bytes_beside(const SceneChange& change) const;
  [[nodiscard]] std::optional<State> state_at(std::uint64_t revision) const;

  std::string name_;
  ObjectOptions options_;
  Limits limits_;
  KeptRevision oldest_;
  State before_;  ///< objects at `oldest_`
  State newest_;
  std::deque<Entry> entries_;
  std::uint64_t entry_bytes_ = 0;  ///< sum over `entries_`
};

}  // namespace camway::scene
