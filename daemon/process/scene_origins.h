// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/process/settings/scene_argument.h"
#include "daemon/scene/log/scene_log.h"

namespace camway::process {

/// Identifies a state of a file; all 0 if there is no file.
struct FileStamp {
  std::int64_t written_ns = 0;
  std::int64_t size = 0;
  std::uint64_t inode = 0;  ///< changes when the file is replaced
  bool operator==(const FileStamp&) const = default;

  static FileStamp of(const std::filesystem::path& file);
};

/// The files and options that configured scenes in a log were read with, so that a start reads only
/// files that have changed. Without a log it knows nothing and keeps nothing.
/// Not thread-safe.
class SceneOrigins {
 public:
  /// Refers to `log`, which must outlive it; null for none. `owner`: whose files these are, if
  /// several processes keep scenes in the log; empty if it is the only one.
  SceneOrigins(scene::SceneLog* log, const std::string& owner);

  struct Origin {
    std::string arguments;  ///< `arguments_of` the scene
    FileStamp stamp;
    bool is_dropped = false;  ///< the scene is no longer wanted, but may not be removed yet
  };
  /// Returns the origin of a scene; nothing if it is not known.
  [[nodiscard]] std::optional<Origin> find(std::string_view name) const;
  [[nodiscard]] std::vector<std::string> names() const;

  void set(const SceneArgument& scene, const FileStamp& stamp);
  /// Notes that the scene is no longer wanted, or that it is wanted after all.
  void mark_dropped(const std::string& name, bool is_dropped);
  void erase(const std::string& name);

  /// Returns another owner whose note has the scene, and wants it; empty if there is none. Fails if
  /// the notes cannot be read.
  [[nodiscard]] base::Result<std::string> other_owner_of(const std::string& name) const;

  /// Returns another owner that wants the scene and reads it with another scale, other axes or
  /// another kind of unknown space; empty if there is none, or if it is not known.
  [[nodiscard]] std::string other_reader_of(const SceneArgument& scene) const;

  /// Returns a text that is equal for scenes that are read alike from the same file.
  static std::string arguments_of(const SceneArgument& scene);
  /// Returns a text that is equal for scenes whose files are read alike.
  static std::string reading_of(const SceneArgument& scene);
  /// Returns a text that is equal for scenes that are read alike.
  static std::string options_of(const SceneArgument& scene);
  /// Returns the end of both texts: options of the whole scene, not of the object of the file.
  static std::string scene_options_of(const SceneArgument& scene);

 private:
  void save();

  scene::SceneLog* log_;
  const bool is_shared_;
  const std::string note_key_;
  std::map<std::string, Origin, std::less<>> origins_;
};

}  // namespace camway::process
