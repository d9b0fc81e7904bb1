// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "daemon/scene/snapshot/scene_change.h"
#include "daemon/scene/snapshot/snapshot.h"

namespace camway::scene {

/// The reason why a journal does not keep a change.
enum class KeepFault : std::uint8_t {
  kNone,
  kOutrun,  ///< another process has changed the scene first
  kFull,    ///< there is no room for it
  kBroken,  ///< it cannot be written
};

/// Whether a journal keeps a change.
struct Keeping {
  KeepFault fault = KeepFault::kNone;  ///< kNone: the change is durable
  std::string error;                   ///< empty exactly without a fault
};

/// Keeps the changes of a store beyond the life of the process. The store makes a change only once
/// it is durable. The store never calls for one scene on two threads at a time, but does so for
/// different scenes.
class SceneJournal {
 public:
  virtual ~SceneJournal() = default;

  /// Keeps a scene with a new history. `before`: the newest revision of the scene that it replaces;
  /// 0 if there is none.
  virtual Keeping keep_scene(const Snapshot& first, std::uint64_t before,
                             const ChangeNote& note) = 0;

  /// Keeps changes that made `next` of `before`. `oldest_revision`: the oldest that can still be
  /// restored.
  virtual Keeping keep_changes(const Snapshot& before, const Snapshot& next,
                               const SceneChanges& changes, const ChangeNote& note,
                               std::uint64_t oldest_revision) = 0;

  /// Keeps that a scene is removed, whose newest snapshot is `last`. `request` names the request
  /// for it (`ChangeNote::request`); empty: none.
  virtual Keeping keep_removal(const Snapshot& last, const std::string& request) = 0;

  /// Waits until another process's change of a scene has arrived, whose newest revision was
  /// `revision` here (0: there was none). Returns false if none comes.
  virtual bool await_other(const std::string& scene, std::uint64_t revision) = 0;

  /// Waits until all changes have arrived that other processes had made when this was called.
  /// Returns false if that takes too long, or if no other process changes scenes.
  virtual bool catch_up() = 0;
};

}  // namespace camway::scene
