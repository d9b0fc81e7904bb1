// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/record/blob_log.h"
#include "daemon/record/log_files.h"
#include "daemon/scene/log/shared_log.h"

namespace camway::record {

/// A log of scenes that only passes changes on, to be written among the messages, and puts blobs
/// into the folder of a recording. It reads no scenes.
/// Not thread-safe.
class UpdateLog final : public BlobLog {
 public:
  using Take = std::function<void(scene::LogUpdate)>;

  /// `files` must outlive this.
  UpdateLog(LogFiles& files, Take take) : files_(files), take_(std::move(take)) {}

  /// Forgets the blobs that were not asked for between the two calls.
  void begin_file() { older_ = std::exchange(needs_, {}); }
  void end_begin() { older_.clear(); }

  /// The result of the last `put_blob` that failed.
  [[nodiscard]] const scene::AppendResult& fault() const { return fault_; }

  scene::AppendResult put_blob(const scene::BlobId& id, const scene::Blob& blob) override;
  /// Also marks the blob, and those that it needs, as used by the present file.
  bool has_blob(const scene::BlobId& id) override;
  base::Result<scene::Bytes> blob(const scene::BlobId& id) override { return files_.blob(id); }
  scene::AppendResult append(std::string_view scene, const scene::LogEntry& entry) override;
  scene::AppendResult remove(std::string_view scene, std::uint64_t revision,
                             std::string_view request) override;

 private:
  using Needs = std::map<scene::BlobId, std::vector<scene::BlobId>>;

  LogFiles& files_;
  scene::AppendResult fault_;
  const Take take_;
  Needs needs_;  ///< blobs that each blob of this file needs
  Needs older_;  ///< blobs that each blob of the file before needs
};

}  // namespace camway::record
