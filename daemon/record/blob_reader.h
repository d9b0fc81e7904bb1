// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "daemon/record/blob_folder.h"
#include "daemon/record/blob_log.h"

namespace camway::record {

/// The contents of objects in the folders of recordings, for reading.
/// Thread-safe.
class BlobReader final : public BlobLog {
 public:
  explicit BlobReader(const std::vector<std::filesystem::path>& folders);

  bool has_blob(const scene::BlobId& id) override;
  /// Fails if none of the folders has it undamaged.
  base::Result<scene::Bytes> blob(const scene::BlobId& id) override;

 private:
  std::vector<BlobFolder> folders_;
};

}  // namespace camway::record
