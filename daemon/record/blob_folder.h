// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>

#include "daemon/base/result.h"
#include "daemon/scene/log/scene_log.h"

namespace camway::record {

/// The contents of objects as files of a folder, each named after the SHA-256 of its bytes, so that
/// many recordings share them.
/// Not thread-safe.
class BlobFolder {
 public:
  using Clock = std::chrono::system_clock;

  /// The folder need not exist.
  explicit BlobFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Writes a blob completely or not at all; one that is there stays. Marks it as used now.
  /// `written` is set to the number of bytes that it takes more than before.
  scene::AppendResult put(const scene::BlobId& id, const scene::Bytes& bytes,
                          std::uint64_t& written);
  /// Marks a blob as used now. Returns false if it is not there.
  bool touch(const scene::BlobId& id) const;
  /// Reads a blob. Fails if it is missing or damaged, with the file.
  [[nodiscard]] base::Result<scene::Bytes> get(const scene::BlobId& id) const;

  /// Removes the blobs that were last used before a time. Returns the number of bytes.
  std::uint64_t remove_unused_since(Clock::time_point time);
  /// The number of bytes of all files.
  [[nodiscard]] std::uint64_t bytes() const;

  [[nodiscard]] std::filesystem::path file_of(const scene::BlobId& id) const;

 private:
  std::filesystem::path folder_;
};

/// Calls the system's `write` until all is written. Returns the system's error, or 0.
int write_all(int fd, const void* bytes, std::size_t count);
/// The result of a write that ended with the system's error `why`; 0: none.
scene::AppendResult append_result(const std::filesystem::path& file, int why);

}  // namespace camway::record
