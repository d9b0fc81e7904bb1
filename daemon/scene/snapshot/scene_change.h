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
    kPut,   ///< adds the object, or puts it in the place of the one of that name
    kMove,  ///< puts it elsewhere
    kRemove,
  };

  Kind kind = Kind::kPut;
  std::string object;
  std::shared_ptr<const ObjectSource> source;  ///< of kPut
  Placement placement;                         ///< of kPut and kMove
};

/// Changes that are made at once, in this order.
using SceneChanges = std::vector<SceneChange>;

/// The scene after `changes`; nothing of what did not change is built again. Fails, with an error
/// that names the object, if it is not there or cannot be where it shall be, or if a stop was asked
/// for meanwhile, as `place_object`. The two snapshots are independent; safe from any thread.
/// Precondition: a source is there where one is needed.
SnapshotResult changed(const Snapshot& before, const SceneChanges& changes, std::uint64_t revision,
                       const std::stop_token& stop = {});
SnapshotResult changed(const Snapshot& before, const SceneChange& change, std::uint64_t revision,
                       const std::stop_token& stop = {});

/// What is remembered of a change beside what it did, for people who look for a revision.
struct ChangeNote {
  std::string operation = {};           ///< a word of who made it: "load", "move" and so on
  std::string object = {};              ///< that was changed; empty: all
  std::string client = {};              ///< who asked for it; empty: nobody
  std::uint64_t restored_revision = 0;  ///< whose objects it has again; 0: of none
  std::chrono::system_clock::time_point when = {};  ///< the store sets it
};

/// A revision that can be built again, and the change that led to it.
struct KeptRevision {
  std::uint64_t revision = 0;
  ChangeNote note = {};
};

/// The changes that led to the newest revision of a scene, as many as the limits allow, and what it
/// was before them: so each of these revisions can be built again. A value type.
class SceneHistory {
 public:
  struct Limits {
    std::size_t changes = 1024;
    /// Of what is kept for earlier revisions alone, about: see `SceneHistory::bytes`.
    std::uint64_t bytes = std::uint64_t{256} << 20;
  };
  struct Entry {
    KeptRevision made;  ///< that the changes led to, together
    SceneChanges changes;
    std::uint64_t bytes = 0;  ///< of their sources, beside what those before them had
  };

  /// Begins with `first`.
  SceneHistory(const Snapshot& first, const Limits& limits, ChangeNote note = {});

  /// Precondition: `changed` made `made.revision` of the newest one.
  void add(SceneChanges changes, KeptRevision made);

  /// What is kept beside the newest revision, so that earlier ones can be built again: about, and
  /// more only where a source came back that had been gone. What an object's source shares with the
  /// one before it, as an occupancy map does after a scan, counts once. Above 0 only if there is a
  /// change.
  [[nodiscard]] std::uint64_t bytes() const;
  /// Precondition: there is a change.
  void forget_oldest();

  /// The revision before the first change that is still known.
  [[nodiscard]] std::uint64_t oldest_revision() const { return oldest_.revision; }
  [[nodiscard]] const std::deque<Entry>& entries() const { return entries_; }
  /// All that can be built again, oldest first.
  [[nodiscard]] std::vector<KeptRevision> revisions() const;

  /// Builds a revision again, from what the objects are and where they were then: equal to what it
  /// was in everything. Nothing if `revision` is none of those that are known, or if a stop was
  /// asked for.
  [[nodiscard]] std::shared_ptr<const Snapshot> rebuild(std::uint64_t revision,
                                                        const std::stop_token& stop = {}) const;

  /// What makes the newest revision have the objects of that one, each where it was. Nothing if
  /// that is none of those that are known.
  [[nodiscard]] std::optional<SceneChanges> changes_back_to(std::uint64_t revision) const;

 private:
  struct Placed {
    std::shared_ptr<const ObjectSource> source;
    Placement placement;
  };
  struct State {
    std::map<std::string, Placed, std::less<>> objects;
    std::uint64_t bytes = 0;  ///< of their sources

    void put(std::string_view name, const Placed& placed);
    void remove(std::string_view name);
    void apply(const SceneChange& change);
    void apply(const SceneChanges& changes);
  };

  /// What the change keeps that the newest revision has not.
  [[nodiscard]] std::uint64_t bytes_beside(const SceneChange& change) const;
  [[nodiscard]] std::optional<State> state_at(std::uint64_t revision) const;

  std::string name_;
  ObjectOptions options_;
  Limits limits_;
  KeptRevision oldest_;
  State before_;  ///< at `oldest_`
  State newest_;
  std::deque<Entry> entries_;
  std::uint64_t entry_bytes_ = 0;  ///< of all of them
};

}  // namespace camway::scene
