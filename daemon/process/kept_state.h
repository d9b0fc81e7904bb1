// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "daemon/base/result.h"
#include "daemon/process/settings/daemon_options.h"
#include "daemon/scene/log/durable_scenes.h"
#include "daemon/scene/log/sqlite/sqlite_log.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/log/log.h"

namespace camway::process {

/// The log in which the daemon keeps its scenes beyond its own life.
class KeptState {
 public:
  /// Opens the log of a folder, or makes it. Fails if it cannot be used or is damaged, with what to
  /// do.
  static base::Result<std::unique_ptr<KeptState>> open(const StateOptions& options);

  /// Uses a log that other processes may write too. `place` says where it is, for the log of the
  /// daemon; `patience` is that of `DurableScenes`.
  KeptState(std::string place, std::unique_ptr<scene::SceneLog> log,
            std::chrono::milliseconds patience)
      : place_(std::move(place)),
        is_shared_(patience.count() > 0),
        log_(std::move(log)),
        scenes_(*log_, patience) {}

  /// The log and the scenes in it live as long as this.
  [[nodiscard]] scene::SceneLog& log() { return *log_; }
  [[nodiscard]] scene::DurableScenes& scenes() { return scenes_; }

  /// Puts the scenes that are kept into a store. Returns a fault, or an empty text. Must be called
  /// once, before any change of the store.
  std::string load_into(scene::SceneStore& store, service::Log& log);

 private:
  const std::string place_;
  const bool is_shared_;  ///< other processes write the log, too
  std::unique_ptr<scene::SceneLog> log_;
  scene::DurableScenes scenes_;
};

}  // namespace camway::process
