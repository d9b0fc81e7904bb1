// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "daemon/base/file_descriptor.h"
#include "daemon/base/result.h"
#include "daemon/record/blob_folder.h"
#include "daemon/scene/log/scene_log.h"

namespace camway::record {

/// The ending of the files of a recording.
inline constexpr char kLogEnding[] = ".lcmlog";
/// The folder of blobs beside the files.
inline constexpr char kBlobFolder[] = "blobs";

/// The size of a recording.
struct RecordLimits {
  /// Size and age at which a file ends and the next one begins.
  std::size_t file_bytes = std::size_t{256} << 20;
  std::chrono::milliseconds file_time{3'600'000};
  /// Limit of all files and blobs together. Before it is exceeded, the oldest files are removed,
  /// and the blobs that no other file needs.
  std::size_t most_bytes = std::size_t{8} << 30;
};

/// Returns why a folder can be neither written nor made; empty if it can. Makes nothing, and so
/// does not disturb a daemon that records into it.
std::string folder_fault(const std::filesystem::path& folder);

/// The files of a folder of recordings: the one that is being written, and older ones.
/// Not thread-safe.
class LogFiles {
 public:
  /// Makes the folder, and locks it. Fails if it cannot be written, or if another process records
  /// into it.
  static base::Result<LogFiles> open(const std::filesystem::path& folder, std::string recording,
                                     const RecordLimits& limits);

  /// Returns whether the present file is too old, or too large with the bytes that wait to be
  /// appended, or there is none.
  [[nodiscard]] bool is_over(std::size_t waiting_bytes = 0) const;
  /// Begins the next file.
  scene::AppendResult begin_next();
  /// Appends whole events, all of them or none. Requires a present file.
  scene::AppendResult append(std::span<const std::uint8_t> events);
  /// Keeps a blob that the present file needs.
  scene::AppendResult put_blob(const scene::BlobId& id, const scene::Bytes& bytes);
  [[nodiscard]] bool has_blob(const scene::BlobId& id) const { return blobs_.touch(id); }
  [[nodiscard]] base::Result<scene::Bytes> blob(const scene::BlobId& id) const {
    return blobs_.get(id);
  }

  /// Number of the present file, from 1; 0 before the first one.
  [[nodiscard]] std::uint64_t part() const { return part_; }

 private:
  using Steady = std::chrono::steady_clock;

  LogFiles(std::filesystem::path folder, std::string recording, const RecordLimits& limits,
           base::FileDescriptor lock);

  /// Removes old files until there is room. Returns false if there is none.
  bool make_room(std::uint64_t bytes);
  bool remove_oldest();

  std::filesystem::path folder_;
  std::string recording_;
  RecordLimits limits_;
  base::FileDescriptor lock_;
  BlobFolder blobs_;
  std::filesystem::path file_;
  std::optional<base::FileDescriptor> fd_;  ///< of the present file
  std::uint64_t part_ = 0;
  std::uint64_t file_bytes_ = 0;
  std::uint64_t all_bytes_ = 0;  ///< of all files and blobs
  Steady::time_point begun_{};
};

}  // namespace camway::record
