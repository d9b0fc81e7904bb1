// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace camway::service {

/// A file below a root, or an error.
struct RootedFile {
  std::filesystem::path file;  ///< canonical; empty on error
  std::string error;           ///< names the requested file, but nothing outside the roots
};

/// The folders that clients may have scene files read from. Immutable.
/// Thread-safe.
class SceneRoots {
 public:
  SceneRoots() = default;
  /// Looks up the folders. Sets `error` if one does not exist or is no folder.
  static SceneRoots make(const std::vector<std::filesystem::path>& folders, std::string& error);

  [[nodiscard]] bool empty() const { return folders_.empty(); }

  /// Returns the regular file that `asked` names: relative to a root (the first root that has it
  /// counts), or absolute and below one. Refuses a path with a component "..", and a path that
  /// links lead out of the root. A user who may write below a root could still replace a folder by
  /// a link between this call and the reading of the file, so roots are for trusted users only.
  [[nodiscard]] RootedFile resolve(std::string_view asked) const;

  /// Writes `bytes` as the file that `asked` names, in an existing folder below a root. Replaces a
  /// file of that name once all bytes are written. Refuses a name that does not end with
  /// `extension`, so that no other files can be replaced. Returns an error or an empty text.
  [[nodiscard]] std::string write(std::string_view asked, std::string_view extension,
                                  std::string_view bytes) const;

 private:
  std::vector<std::filesystem::path> folders_;  ///< canonical
};

}  // namespace camway::service
