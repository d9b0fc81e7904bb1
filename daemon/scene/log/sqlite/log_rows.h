// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/scene/log/scene_log.h"
#include "daemon/scene/log/sqlite/sqlite_database.h"

namespace camway::scene {

/// Reads the rows of a log, and verifies each. A failure says what is damaged or lost, or has
/// SQLite's words, without the name of the file. The caller keeps others from changing the rows
/// in between (`SqliteDatabase::read_at_once`).

/// Returns all scenes in order of name. Fails if a row of any of them is damaged or missing, or a
/// blob is missing that anything needs.
base::Result<std::vector<LoggedScene>> read_logged_scenes(SqliteDatabase& database);

/// Returns a blob with verified bytes.
base::Result<Blob> read_blob(SqliteDatabase& database, const BlobId& id);

/// Returns why the bytes of any blob are not what they were; empty otherwise.
std::string fault_of_blobs(SqliteDatabase& database);

/// Returns why a note or the highest removed revision is damaged; empty otherwise.
std::string fault_of_notes(SqliteDatabase& database);

/// Returns what SQLite's own check of the file's structure found; empty for nothing. `pragma` is
/// `quick_check` or `integrity_check`.
std::string fault_of_structure(SqliteDatabase& database, const std::string& pragma);

/// Returns a number of the table `meta`; 0 if it is not there.
std::uint64_t read_meta(SqliteDatabase& database, std::string_view key);

/// Returns what is wrong if the database of a folder lacks transactions that were answered
/// (`CommitCount`); empty otherwise.
std::string fault_of_commits(const std::filesystem::path& folder, SqliteDatabase& database);

}  // namespace camway::scene
