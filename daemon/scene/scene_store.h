// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/scene/snapshot.h"

namespace camway::scene {

/// The scenes that a daemon holds, by name: the newest snapshot of each. A snapshot that someone
/// took stays as it is when its scene is replaced. Safe from any thread.
class SceneStore {
 public:
  /// Adds the scene, or replaces the snapshot of that name. Precondition: not null.
  void put(std::shared_ptr<const Snapshot> snapshot);

  /// Whether there was such a scene.
  bool remove(std::string_view name);

  /// The newest snapshot, or null.
  [[nodiscard]] std::shared_ptr<const Snapshot> find(std::string_view name) const;

  /// All scenes in order of name.
  [[nodiscard]] std::vector<std::shared_ptr<const Snapshot>> list() const;

  /// For a person who asked for a scene that is not there: the first names, and how many more.
  [[nodiscard]] std::string summary() const;

 private:
  mutable std::mutex mutex_;  ///< guards scenes_
  std::map<std::string, std::shared_ptr<const Snapshot>, std::less<>> scenes_;
};

}  // namespace camway::scene
