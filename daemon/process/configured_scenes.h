// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "daemon/process/scene_origins.h"
#include "daemon/process/settings/scene_argument.h"
#include "daemon/scene/cache/scene_cache.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/log/log.h"

namespace camway::process {

/// The scenes that command line and configuration name, in a store that may hold others too.
/// Not thread-safe.
class ConfiguredScenes {
 public:
  /// `store` must outlive this. `cache` has the prepared forms of scenes that are loaded.
  /// `scene_log` is the one that keeps the store, null for none, and must outlive this. `owner` is
  /// the name of this process if others keep scenes in the log too, else empty.
  ConfiguredScenes(scene::SceneStore& store, std::shared_ptr<service::Log> log,
                   std::optional<scene::SceneCache> cache = std::nullopt,
                   scene::SceneLog* scene_log = nullptr, const std::string& owner = "")
      : store_(store),
        log_(std::move(log)),
        cache_(std::move(cache)),
        origins_(scene_log, owner),
        is_shared_(!owner.empty()) {}

  /// Makes the store hold `wanted`, and removes the scenes of earlier calls, and of earlier
  /// processes with the same log, that are no longer wanted, unless another process that shares the
  /// log wants them. A scene that the log has is taken from there. Where its file or the options to
  /// read it have changed since, the new content replaces that of the file, and what clients added
  /// stays; where it cannot be read, the scene stays as it was, with a warning. Loads scenes that
  /// are new, whose own options changed (occupancy, bounds), or that changed in any way since an
  /// earlier call, and logs what was read and assumed. Warns of options of a scene that another
  /// process or a client made in another way. If a scene cannot be loaded, or a stop is requested,
  /// changes nothing but files that scenes of the log were made of, and returns false; a fault is
  /// logged with the file and the reason. Also returns false if the store has no room for a scene;
  /// then only that one is left out.
  bool update(const std::vector<SceneArgument>& wanted, const std::stop_token& stop = {});

  /// Returns the first scene that the last `update` could not load or hold, with the reason. Empty
  /// if `update` returned true, or a stop ended it.
  [[nodiscard]] const std::string& fault() const { return fault_; }

  /// Returns whether any scene is to be read again when its file changes.
  [[nodiscard]] bool watches_files() const;

  /// Checks the files of these scenes. Reads a file again if it changed and then stayed the same
  /// until the next check, so that its writer is done. The new object replaces the one that was
  /// read before; objects that clients added to the scene stay. If the file is gone or cannot be
  /// read, keeps all as it was, with a warning; a reading that a stop ends is repeated the next
  /// time. Files are polled, since network drives do not report changes.
  void look_at_files(const std::stop_token& stop = {});

 private:
  struct Held {
    SceneArgument scene;
    FileStamp stamp;          ///< state that the store has
    FileStamp seen = stamp;   ///< state at the last check
    FileStamp tried = stamp;  ///< state that was last read, or could not be read
  };

  void look_at(Held& held, const std::stop_token& stop);
  /// Returns whether the scene holds the present content of the file.
  bool read_again(const SceneArgument& scene, const std::stop_token& stop);
  [[nodiscard]] bool holds(const Held& wanted) const;
  /// Returns whether the log has the scene, with the present content of its file if that is there.
  /// A scene that another process has put into the log counts, too.
  bool holds_from_log(const Held& wanted, const std::stop_token& stop);
  [[nodiscard]] std::shared_ptr<const scene::Snapshot> load(const SceneArgument& scene,
                                                            const std::stop_token& stop);
  /// Warns if a scene that is put anew has objects of clients.
  void warn_of_losses(const std::string& name);
  /// Warns of options with which the scene that is kept was not made.
  void warn_of_options(const scene::Snapshot& kept, const SceneArgument& scene);
  void note_fault(const std::string& scene, const std::string& reason);
  void remove(const std::string& name);
  void remove_all_but(const std::vector<SceneArgument>& wanted);

  scene::SceneStore& store_;
  std::shared_ptr<service::Log> log_;
  std::optional<scene::SceneCache> cache_;
  SceneOrigins origins_;
  const bool is_shared_;
  std::vector<Held> held_;
  std::string fault_;
};

}  // namespace camway::process
