// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "daemon/base/digest.h"
#include "daemon/scene/log/scene_log.h"

namespace camway::scene {

/// Digests of all that a row of the log means, with the blobs that it needs: SQLite's pages have no
/// checksums, so a bit that a disk changes would go unnoticed. The same on all machines.
base::Digest::Bytes entry_digest(std::string_view scene, const LogEntry& entry);
base::Digest::Bytes summary_digest(std::string_view scene, std::uint64_t revision,
                                   const Bytes& summary, const std::vector<BlobId>& needs);
base::Digest::Bytes blob_digest(const BlobId& id, const Blob& blob);
base::Digest::Bytes note_digest(std::string_view key, std::string_view text);
base::Digest::Bytes meta_digest(std::string_view key, std::uint64_t value);

}  // namespace camway::scene
