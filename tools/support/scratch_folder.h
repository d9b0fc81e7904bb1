// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>
#include <utility>

#include "daemon/base/result.h"

namespace camway::tools {

/// A new folder below the system's folder for temporary files. The destructor removes it with all
/// that it holds. Not thread-safe.
class ScratchFolder {
 public:
  /// Makes a folder that only this user may enter, "camway-PURPOSE-" and six random characters.
  /// Fails if it cannot be made, with its name.
  static base::Result<ScratchFolder> make(std::string_view purpose);
  ~ScratchFolder();
  ScratchFolder(ScratchFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  ScratchFolder& operator=(ScratchFolder&&) = delete;
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit ScratchFolder(std::filesystem::path path) : path_(std::move(path)) {}

  std::filesystem::path path_;  ///< empty after a move
};

}  // namespace camway::tools
