// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stop_token>
#include <vector>

#include "daemon/process/scene_argument.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/log/log.h"

namespace camway::service {

/// The scenes that command line and configuration name, in a store that may hold others too. For
/// one thread at a time.
class ConfiguredScenes {
 public:
  /// `store` must outlive this.
  ConfiguredScenes(scene::SceneStore& store, std::shared_ptr<Log> log)
      : store_(store), log_(std::move(log)) {}

  /// Makes the store hold `wanted`, and none of those that it held for an earlier call and that are
  /// not wanted any more. Loads what is new, what is to be read in another way and what changed on
  /// disk, and logs what was read and assumed. If one cannot be loaded, or a stop is asked for in
  /// between, nothing changes and the answer is false, with the file and the reason logged; so it
  /// is if the store has no room for one, which then is the only one left out.
  bool update(const std::vector<SceneArgument>& wanted, const std::stop_token& stop = {});

  /// Why the last `update` was false: the first scene that could not be loaded or held, and the
  /// reason. Empty where it was true or a stop ended it.
  [[nodiscard]] const std::string& fault() const { return fault_; }

  /// Whether any scene asks to be read again when its file changes.
  [[nodiscard]] bool watches_files() const;

  /// Looks at the files of those scenes. One that changed and then stayed as it was until the next
  /// look, so that its writer is done, is read again, and takes the place of what was read of it
  /// before; what clients added to the scene stays. If it cannot be read, or is gone, all stays as
  /// it was, with a warning; what a stop ends is read the next time. By polling, as network drives
  /// tell nobody of changes.
  void look_at_files(const std::stop_token& stop = {});

 private:
  /// By which a change on disk shows; all 0 where there is no file.
  struct FileStamp {
    std::int64_t written_ns = 0;
    std::int64_t size = 0;
    std::uint64_t inode = 0;  ///< another one when the file was replaced
    bool operator==(const FileStamp&) const = default;
  };
  struct Held {
    SceneArgument scene;
    FileStamp stamp;          ///< of what was read
    FileStamp seen = stamp;   ///< at the last look
    FileStamp tried = stamp;  ///< of what was read last, or could not be
  };

  static FileStamp stamp_of(const std::filesystem::path& file);
  void look_at(Held& held, const std::stop_token& stop);
  /// Whether the scene has what is in the file now.
  bool read_again(const SceneArgument& scene, const std::stop_token& stop);
  [[nodiscard]] bool holds(const Held& wanted) const;
  [[nodiscard]] std::shared_ptr<const scene::Snapshot> load(const SceneArgument& scene,
                                                            const std::stop_token& stop);
  void note_fault(const std::string& scene, const std::string& reason);
  void remove_all_but(const std::vector<SceneArgument>& wanted);

  scene::SceneStore& store_;
  std::shared_ptr<Log> log_;
  std::vector<Held> held_;
  std::string fault_;
};

}  // namespace camway::service
