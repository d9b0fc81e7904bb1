// SPDX-License-Identifier: MIT
#include "daemon/record/blob_reader.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "daemon/record/session_events.h"

namespace camway::record {

namespace fs = std::filesystem;

BlobReader::BlobReader(const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) folders_.emplace_back(folder);
}

bool BlobReader::has_blob(const scene::BlobId& id) {
  std::error_code error;
  return std::ranges::any_of(
      folders_, [&](const BlobFolder& folder) { return fs::exists(folder.file_of(id), error); });
}

base::Result<scene::Bytes> BlobReader::blob(const scene::BlobId& id) {
  std::string fault = hex_of(id) + ": there is no such content";
  for (const BlobFolder& folder : folders_) {
    base::Result<scene::Bytes> bytes = folder.get(id);
    if (bytes) return bytes;
    fault = std::move(bytes.error);
  }
  return base::Failure{std::move(fault)};
}

}  // namespace camway::record
