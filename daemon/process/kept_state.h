// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "daemon/process/settings/daemon_options.h"
#include "daemon/scene/log/durable_scenes.h"
#include "daemon/scene/log/sqlite_log.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/log/log.h"

namespace camway::process {

/// The folder in which the daemon keeps its scenes beyond its own life.
class KeptState {
 public:
  /// Opens the folder, or makes it. Fails if it cannot be used or is damaged, with what to do.
  static base::Result<std::unique_ptr<KeptState>> open(const StateOptions& options);

  /// The log and the journal live as long as this.
  [[nodiscard]] scene::SceneLog& log() { return *log_; }
  [[nodiscard]] scene::SceneJournal& journal() { return scenes_; }

  /// Puts the scenes that are kept into a store. Returns a fault, or an empty text. Must be called
  /// once, before any change of the store.
  std::string load_into(scene::SceneStore& store, service::Log& log);

 private:
  KeptState(std::string folder, std::unique_ptr<scene::SceneLog> log)
      : folder_(std::move(folder)), log_(std::move(log)), scenes_(*log_) {}

  const std::string folder_;
  std::unique_ptr<scene::SceneLog> log_;
  scene::DurableScenes scenes_;
};

}  // namespace camway::process
