// SPDX-License-Identifier: MIT
#include "daemon/record/update_log.h"

#include <algorithm>

namespace camway::record {

using scene::AppendResult;

AppendResult UpdateLog::put_blob(const scene::BlobId& id, const scene::Blob& blob) {
  AppendResult done = files_.put_blob(id, blob.bytes);
  if (done.fault != scene::AppendFault::kNone) {
    fault_ = done;
  } else if (!blob.needs.empty()) {
    needs_[id] = blob.needs;
  }
  return done;
}

bool UpdateLog::has_blob(const scene::BlobId& id) {
  if (!files_.has_blob(id)) return false;
  if (const auto older = older_.find(id); older != older_.end()) needs_.insert(*older);
  const auto found = needs_.find(id);
  if (found == needs_.end()) return true;
  const std::vector<scene::BlobId> needs = found->second;
  return std::ranges::all_of(needs, [this](const scene::BlobId& each) { return has_blob(each); });
}

AppendResult UpdateLog::append(std::string_view scene, const scene::LogEntry& entry) {
  take_({scene::LogUpdate::Kind::kEntry, std::string(scene), entry, 0});
  return {};
}

AppendResult UpdateLog::remove(std::string_view scene, std::uint64_t revision,
                               std::string_view /*request*/) {
  take_({scene::LogUpdate::Kind::kRemoval, std::string(scene), {revision, revision, {}, {}}, 0});
  return {};
}

}  // namespace camway::record
