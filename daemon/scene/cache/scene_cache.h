// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/scene/cache/prepared_scene.h"
#include "daemon/scene/cache/scene_key.h"

namespace camway::scene {

struct SceneCacheLimits {
  /// Size of all files together. The scene that was used the longest ago makes room.
  std::uint64_t bytes = std::uint64_t{2} << 30;
  /// Scenes with fewer triangles are not kept: reading and preparing them takes less than 10 ms, of
  /// which most go to the import process, and many small files would be slow to look through.
  std::size_t least_triangles = 500;
};

/// A prepared scene in the cache.
struct CachedScene {
  std::string key;         ///< `SceneKey` as text
  std::string scene_file;  ///< file that it was read from, in printable ASCII
  double scale = 1.0;      ///< with which it was read, as `ImportOptions` has it
  UpAxis up = UpAxis::kAsInFile;
  std::uint64_t triangles = 0;
  std::uint64_t bytes = 0;
  std::chrono::system_clock::time_point last_used;
  bool is_of_this_build = false;  ///< else this program cannot use it
};

/// A folder of prepared scenes, shared by all programs of a user. It only ever saves time: whatever
/// is wrong with the folder or a file in it, the scene is read and prepared as without a cache.
///
/// Files are written under another name and renamed, so nobody sees half of one. The folder is made
/// with mode 0700, files with 0600. A folder or file that belongs to another user, or that others
/// may write to, is not used. A file that `read_prepared` refuses is removed. The time at which a
/// file was last written is that of its last use.
/// A value type. Thread-safe; processes may use a folder at the same time.
class SceneCache {
 public:
  explicit SceneCache(std::filesystem::path folder, const SceneCacheLimits& limits = {})
      : folder_(std::move(folder)), limits_(limits) {}

  /// Returns why the folder is not used, in words that follow its name: "belongs to another user".
  /// Empty if it can be used, or is not there yet and can be made.
  [[nodiscard]] std::string fault() const;

  /// Returns the scene of this key, or nothing. The options are those that the key was made with.
  [[nodiscard]] std::optional<PreparedScene> find(const SceneKey& key,
                                                  const ImportOptions& options) const;

  /// Keeps a scene that was read from `scene_file`. Returns false if it is smaller or larger than
  /// the limits allow, or cannot be written.
  bool store(const SceneKey& key, const std::filesystem::path& scene_file,
             const PreparedScene& prepared) const;

  /// Returns the scenes in the folder, the one last used first. Leaves out damaged files.
  [[nodiscard]] std::vector<CachedScene> scenes() const;

  /// Removes all files of the cache, damaged and unfinished ones too. Returns the number of scenes.
  std::size_t clear() const;

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const SceneCacheLimits& limits() const { return limits_; }

 private:
  std::filesystem::path folder_;
  SceneCacheLimits limits_;
};

/// Returns the folder of this user's cache: $CAMWAY_CACHE_DIR, else $XDG_CACHE_HOME/camway, else
/// ~/.cache/camway. Empty, for no cache, if the first is set and empty, or none of them is set.
std::filesystem::path cache_folder_of_environment();

/// The cache of this user, or why there is none.
struct UserCache {
  std::optional<SceneCache> cache;
  std::string absence;  ///< set if there is no cache: "CAMWAY_CACHE_BYTES is 0"
  /// Set if $CAMWAY_CACHE_BYTES is no whole number; the limit is the default then.
  std::string fault;
};

/// Returns the cache in `cache_folder_of_environment`, whose size $CAMWAY_CACHE_BYTES limits. There
/// is none without a folder, or if the limit is 0.
UserCache cache_of_environment();

}  // namespace camway::scene
