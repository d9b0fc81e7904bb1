// SPDX-License-Identifier: MIT
#include "daemon/scene/log/sqlite/sqlite_schema.h"

#include <algorithm>
#include <string>

#include "daemon/scene/log/sqlite/row_digest.h"
#include "daemon/scene/log/sqlite/state_files.h"

namespace camway::scene {
namespace {

namespace fs = std::filesystem;

/// "CamW", which tells the file from other databases.
constexpr std::uint64_t kApplicationId = 0x43616d57;

// `heads` is what an append is compared with, and tells which rows of a scene must be there. The
// bytes of blobs stand last, so that other columns are read without them. Blobs have numbers
// because only rows with numbers are read piece by piece. `place` keeps the order of needs.
constexpr const char* kTables = R"(
CREATE TABLE heads(
  scene TEXT NOT NULL PRIMARY KEY, revision INTEGER NOT NULL) STRICT, WITHOUT ROWID;
CREATE TABLE entries(
  scene TEXT NOT NULL REFERENCES heads ON DELETE CASCADE, revision INTEGER NOT NULL,
  before INTEGER NOT NULL, digest BLOB NOT NULL, record BLOB NOT NULL,
  PRIMARY KEY(scene, revision)) STRICT, WITHOUT ROWID;
CREATE TABLE entry_needs(
  scene TEXT NOT NULL, revision INTEGER NOT NULL, place INTEGER NOT NULL, blob BLOB NOT NULL,
  PRIMARY KEY(scene, revision, place),
  FOREIGN KEY(scene, revision) REFERENCES entries ON DELETE CASCADE) STRICT, WITHOUT ROWID;
CREATE TABLE summaries(
  scene TEXT NOT NULL PRIMARY KEY REFERENCES heads ON DELETE CASCADE, revision INTEGER NOT NULL,
  digest BLOB NOT NULL, record BLOB NOT NULL) STRICT, WITHOUT ROWID;
CREATE TABLE summary_needs(
  scene TEXT NOT NULL REFERENCES summaries ON DELETE CASCADE, place INTEGER NOT NULL,
  blob BLOB NOT NULL, PRIMARY KEY(scene, place)) STRICT, WITHOUT ROWID;
CREATE TABLE blobs(
  number INTEGER PRIMARY KEY, id BLOB NOT NULL UNIQUE, size INTEGER NOT NULL,
  digest BLOB NOT NULL, bytes BLOB NOT NULL) STRICT;
CREATE TABLE blob_needs(
  owner BLOB NOT NULL REFERENCES blobs(id) ON DELETE CASCADE, place INTEGER NOT NULL,
  blob BLOB NOT NULL, PRIMARY KEY(owner, place)) STRICT, WITHOUT ROWID;
CREATE TABLE notes(
  key TEXT NOT NULL PRIMARY KEY, text TEXT NOT NULL, digest BLOB NOT NULL) STRICT, WITHOUT ROWID;
CREATE TABLE meta(
  key TEXT NOT NULL PRIMARY KEY, value INTEGER NOT NULL, digest BLOB NOT NULL)
  STRICT, WITHOUT ROWID;
)";

bool fill_new_database(SqliteDatabase& database) {
  const std::string identification = "PRAGMA application_id=" + std::to_string(kApplicationId) +
                                     "; PRAGMA user_version=" + std::to_string(kLogSchemaVersion);
  const base::Digest::Bytes digest = meta_digest("highest_removed", 0);
  return database.transact([&] {
    return database.run(identification.c_str()) && database.run(kTables) &&
           database.query("INSERT INTO meta(key, value, digest) VALUES('highest_removed', 0, ?)")
               .with(digest)
               .run() &&
           database.query("INSERT INTO meta(key, value, digest) VALUES('commits', 0, ?)")
               .with(meta_digest("commits", 0))
               .run();
  });
}

}  // namespace

base::Result<bool> create_log_database(const fs::path& file) {
  const fs::path unfinished = file.string() + ".new";
  const std::string fault = make_empty_file(unfinished);
  if (!fault.empty()) return base::Failure{fault};
  {
    const auto database = SqliteDatabase::open(unfinished, SqliteDatabase::Access::kWrite);
    if (!database) return base::Failure{database.error};
    if (!fill_new_database(**database)) {
      return base::Failure{unfinished.string() + ": " + (*database)->failure()->text};
    }
  }
  const std::string unpublished = publish_file(unfinished, file);
  if (!unpublished.empty()) return base::Failure{unpublished};
  return true;
}

base::Result<std::string> version_of_log(SqliteDatabase& database) {
  const std::string application = database.first_text("PRAGMA application_id");
  if (database.failure()) return base::Failure{database.failure()->text};
  if (application != std::to_string(kApplicationId)) {
    return base::Failure{"it holds nothing that camwayd wrote"};
  }
  std::string version = database.first_text("PRAGMA user_version");
  if (database.failure()) return base::Failure{database.failure()->text};
  return version;
}

bool limit_size(SqliteDatabase& database, std::uint64_t most_bytes) {
  // SQLite's own bound of the number of pages.
  constexpr std::uint64_t kMostPages = 4294967294;
  const std::string page_bytes = database.first_text("PRAGMA page_size");
  if (page_bytes.empty()) return false;
  const std::uint64_t pages =
      std::clamp(most_bytes / std::uint64_t{std::stoull(page_bytes)}, std::uint64_t{1}, kMostPages);
  return database.run(("PRAGMA max_page_count=" + std::to_string(pages)).c_str());
}

bool prepare_for_changes(SqliteDatabase& database, std::uint64_t most_bytes) {
  // With WAL and FULL, a commit is durable when it returns. secure_delete would write zeros over
  // the bytes of dropped blobs, which are no secret. journal_size_limit cuts the file of recent
  // changes back after a large blob.
  constexpr const char* kSettings =
      "PRAGMA synchronous=FULL; PRAGMA foreign_keys=ON; PRAGMA secure_delete=OFF; "
      "PRAGMA journal_size_limit=67108864";
  if (database.first_text("PRAGMA journal_mode=WAL") != "wal") return false;
  return database.run(kSettings) && limit_size(database, most_bytes);
}

}  // namespace camway::scene
