// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace camway::service {

/// A file below a root, or why there is none.
struct RootedFile {
  std::filesystem::path file;  ///< canonical; empty on error
  std::string error;           ///< names what was asked for, not what lies outside the roots
};

/// The folders that clients may have scene files read from. Immutable; safe from any thread.
class SceneRoots {
 public:
  SceneRoots() = default;
  /// What is wrong with a folder (it does not exist, it is none) stands in `error`.
  static SceneRoots make(const std::vector<std::filesystem::path>& folders, std::string& error);

  [[nodiscard]] bool empty() const { return folders_.empty(); }

  /// The regular file that `asked` names: relative to a root, of which the first that has it
  /// counts, or absolute and below one. Refused is what has a component "..", and what leads out of
  /// the root, by whatever links. Who may write below a root could still exchange a folder for a
  /// link between this and the reading of the file: roots are for people that one trusts.
  [[nodiscard]] RootedFile resolve(std::string_view asked) const;

  /// Writes `bytes` as the file that `asked` names, in a folder below a root that is there already.
  /// A file of that name is replaced, when all is written. The name must end with `extension`, so
  /// that nothing else can be. Returns what is wrong, or an empty text.
  [[nodiscard]] std::string write(std::string_view asked, std::string_view extension,
                                  std::string_view bytes) const;

 private:
  std::vector<std::filesystem::path> folders_;  ///< canonical
};

}  // namespace camway::service
