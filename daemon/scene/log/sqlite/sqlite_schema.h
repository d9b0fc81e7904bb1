// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "daemon/base/result.h"
#include "daemon/scene/log/sqlite/sqlite_database.h"

namespace camway::scene {

/// Name of the file in the folder of a log.
inline constexpr const char* kLogFile = "scenes.sqlite";

/// Version of the tables. A file with a newer one is refused.
inline constexpr int kLogSchemaVersion = 1;

/// Makes a database without scenes. The file appears under its name when it is complete and
/// durable, so a file that is empty or has no tables is a damaged one. Requires that it is not
/// there. Fails with the reason.
base::Result<bool> create_log_database(const std::filesystem::path& file);

/// Returns the version of the tables of a file. Fails if the file is no log, whatever its content.
base::Result<std::string> version_of_log(SqliteDatabase& database);

/// Sets the size limit, which is never below the size that the file has. Returns false after a
/// failure.
bool limit_size(SqliteDatabase& database, std::uint64_t most_bytes);

/// Sets how changes become durable, and the size limit. Returns false after a failure.
bool prepare_for_changes(SqliteDatabase& database, std::uint64_t most_bytes);

}  // namespace camway::scene
