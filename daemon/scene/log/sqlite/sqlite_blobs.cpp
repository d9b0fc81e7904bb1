// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <utility>

#include "daemon/scene/log/sqlite/log_refusal.h"
#include "daemon/scene/log/sqlite/log_rows.h"
#include "daemon/scene/log/sqlite/row_digest.h"
#include "daemon/scene/log/sqlite/sqlite_log.h"

namespace camway::scene {

AppendResult SqliteLog::put_blob(const BlobId& id, const Blob& blob) {
  assert(blob_id_of(blob.bytes) == id);
  const std::scoped_lock lock(mutex_);
  if (is_there(id)) return {};
  AppendResult too_large = fault_of_size(blob.bytes.size());
  if (too_large.fault != AppendFault::kNone) return too_large;
  return write([&] { return insert_blob(id, blob); });
}

AppendResult SqliteLog::insert_blob(const BlobId& id, const Blob& blob) {
  AppendResult missing = missing_need(blob.needs);
  if (missing.fault != AppendFault::kNone) return missing;
  const base::Digest::Bytes digest = blob_digest(id, blob);
  const bool is_inserted =
      database_->query("INSERT INTO blobs(id, size, digest, bytes) VALUES(?, ?, ?, ?)")
          .with(id)
          .with(std::uint64_t{blob.bytes.size()})
          .with(digest)
          .with(blob.bytes)
          .run();
  if (!is_inserted) return database_fault();
  for (std::size_t i = 0; i < blob.needs.size(); ++i) {
    SqliteQuery need =
        database_->query("INSERT INTO blob_needs(owner, place, blob) VALUES(?, ?, ?)");
    if (!need.with(id).with(std::uint64_t{i}).with(blob.needs[i]).run()) return database_fault();
  }
  return {};
}

bool SqliteLog::has_blob(const BlobId& id) {
  const std::scoped_lock lock(mutex_);
  return is_there(id);
}

base::Result<Bytes> SqliteLog::blob(const BlobId& id) {
  const std::scoped_lock lock(mutex_);
  database_->forget_failure();
  base::Result<Blob> found = base::Failure{"no state can be read"};
  database_->read_at_once([&] {
    found = read_blob(*database_, id);
    return true;
  });
  if (!found) return base::Failure{refusal(place_of_state(folder_), *database_, found.error)};
  return std::move(found->bytes);
}

AppendResult SqliteLog::drop_unused_blobs() {
  const std::scoped_lock lock(mutex_);
  return write_beyond_limit([&] {
    SqliteQuery drop = database_->query(
        "WITH RECURSIVE used(id) AS ("
        "  SELECT blob FROM entry_needs UNION SELECT blob FROM summary_needs"
        "  UNION SELECT blob_needs.blob FROM used JOIN blob_needs ON blob_needs.owner=used.id) "
        "DELETE FROM blobs WHERE id NOT IN (SELECT id FROM used)");
    return drop.run() ? AppendResult{} : database_fault();
  });
}

AppendResult SqliteLog::missing_need(const std::vector<BlobId>& needs) {
  const bool are_there = std::ranges::all_of(needs, [&](const BlobId& id) { return is_there(id); });
  if (are_there) return {};
  return database_->failure()
             ? database_fault()
             : AppendResult{AppendFault::kBroken, "a needed mesh or map is not in the log"};
}

bool SqliteLog::is_there(const BlobId& id) {
  SqliteQuery row = database_->query("SELECT 1 FROM blobs WHERE id=?");
  return row.with(id).next();
}

}  // namespace camway::scene
