// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "daemon/scene/log/sqlite/sqlite_database.h"

namespace camway::scene {

/// Returns how errors name the log of a folder.
std::string place_of_state(const std::filesystem::path& folder);

/// Returns the error of a log that is damaged, with how to go on. `place` names the log: "the state
/// in /var/lib/camway".
std::string damage_text(const std::string& place, const std::string& what);

/// Returns the error of a log that was refused for `what`: that of a damaged one, unless SQLite
/// could not read it for another reason.
std::string refusal(const std::string& place, const SqliteDatabase& database,
                    const std::string& what);

/// Returns why a version of the tables cannot be read; empty if it can.
std::string version_fault(const std::string& place, const std::string& version);

}  // namespace camway::scene
