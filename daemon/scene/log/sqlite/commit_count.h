// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "daemon/base/file_descriptor.h"

namespace camway::scene {

/// The number of transactions of a log that were answered, in a file of its own. SQLite takes its
/// file of recent changes as far as that is whole, and cannot tell changes that were lost there
/// from changes that were never made. The log counts its transactions, too: if it has fewer, some
/// are lost.
class CommitCount {
 public:
  static constexpr const char* kFile = "commits";

  /// Returns the number in the file of a folder; nothing if there is no such file, or no number in
  /// it.
  static std::optional<std::uint64_t> read(const std::filesystem::path& folder);

  /// Opens the file for writing, and makes it if it is missing.
  explicit CommitCount(const std::filesystem::path& folder);
  /// Makes a number durable. Returns false, with `errno` set, if that failed.
  [[nodiscard]] bool write(std::uint64_t count) const;

 private:
  base::FileDescriptor file_;
};

}  // namespace camway::scene
