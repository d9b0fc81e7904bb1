// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"

namespace camway::service {

/// The folders that clients may have scene files read from. Immutable.
/// Thread-safe.
class SceneRoots {
 public:
  SceneRoots() = default;
  /// Looks up the folders. Fails if one does not exist or is no folder.
  static base::Result<SceneRoots> make(const std::vector<std::filesystem::path>& folders);

  [[nodiscard]] bool empty() const { return folders_.empty(); }

  /// Returns the canonical path of the regular file that `asked` names: relative to a root (the
  /// first root that has it counts), or absolute and below one. Refuses a path with a component
  /// "..", and a path that links lead out of the root. A user who may write below a root could
  /// still replace a folder by a link between this call and the reading of the file, so roots are
  /// for trusted users only. The error names `asked`, but nothing outside the roots.
  [[nodiscard]] base::Result<std::filesystem::path> resolve(std::string_view asked) const;

  /// Writes `bytes` as the file that `asked` names, in an existing folder below a root. Replaces a
  /// file of that name once all bytes are written. Refuses a name that does not end with
  /// `extension`, so that no other files can be replaced. Returns an error or an empty text.
  [[nodiscard]] std::string write(std::string_view asked, std::string_view extension,
                                  std::string_view bytes) const;

 private:
  std::vector<std::filesystem::path> folders_;  ///< canonical
};

}  // namespace camway::service
