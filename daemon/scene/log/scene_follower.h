// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "daemon/scene/log/durable_scenes.h"
#include "daemon/scene/log/shared_log.h"
#include "daemon/scene/snapshot/scene_store.h"

namespace camway::scene {

/// Brings the changes that other processes append to a log into a store, while it lives.
class SceneFollower {
 public:
  /// Called with a sentence for the user when the store cannot make a change that is in the log.
  using Warn = std::function<void(const std::string&)>;
  /// Called with the position in the log up to which the store has all changes, but for those that
  /// were warned of.
  using Advanced = std::function<void(std::uint64_t position)>;

  /// Called when a change that another process has made is in the store: with the newest snapshot
  /// of the scene, or the last one of a scene that was removed.
  using Changed = std::function<void(const Snapshot& scene, bool is_removed)>;

  /// Requires that `log`, `scenes` and `store` outlive this, that `scenes` keeps `store` in `log`
  /// or nothing does, and that the scenes of the log were loaded into the store. `warn`,
  /// `advanced` and `changed` are called on another thread; `advanced` when `position` has changed.
  SceneFollower(SharedLog& log, DurableScenes& scenes, SceneStore& store, Warn warn,
                Advanced advanced = {}, Changed changed = {});
  ~SceneFollower();
  SceneFollower(const SceneFollower&) = delete;
  SceneFollower& operator=(const SceneFollower&) = delete;

 private:
  void take(const LogUpdate& update);

  SharedLog& log_;
  DurableScenes& scenes_;
  SceneStore& store_;
  const Warn warn_;
  const Advanced advanced_;
  const Changed changed_;
  std::uint64_t position_;
};

}  // namespace camway::scene
