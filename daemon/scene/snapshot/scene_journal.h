// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/scene/snapshot/scene_change.h"
#include "daemon/scene/snapshot/snapshot.h"

namespace camway::scene {

/// Keeps the changes of a store beyond the life of the process. Each function returns an empty text
/// once the change is durable. Otherwise it returns the reason, and the store does not make the
/// change. The store never calls for one scene on two threads at a time, but does so for different
/// scenes.
class SceneJournal {
 public:
  virtual ~SceneJournal() = default;

  /// Keeps a scene with a new history. `before`: the newest revision of the scene that it replaces;
  /// 0 if there is none.
  virtual std::string keep_scene(const Snapshot& first, std::uint64_t before,
                                 const ChangeNote& note) = 0;

  /// Keeps changes that made `next` of `before`. `oldest_revision`: the oldest that can still be
  /// restored.
  virtual std::string keep_changes(const Snapshot& before, const Snapshot& next,
                                   const SceneChanges& changes, const ChangeNote& note,
                                   std::uint64_t oldest_revision) = 0;

  /// Keeps that a scene is removed, whose newest snapshot is `last`.
  virtual std::string keep_removal(const Snapshot& last) = 0;
};

}  // namespace camway::scene
