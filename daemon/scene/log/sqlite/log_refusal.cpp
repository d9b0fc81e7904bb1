// SPDX-License-Identifier: MIT
#include "daemon/scene/log/sqlite/log_refusal.h"

#include "daemon/scene/log/sqlite/sqlite_schema.h"

namespace camway::scene {

std::string place_of_state(const std::filesystem::path& folder) {
  return "the state in " + folder.string();
}

std::string damage_text(const std::string& place, const std::string& what) {
  return place + " is damaged: " + what +
         ". Restore an export of it with `camway state restore`, or move the folder away to begin "
         "anew";
}

std::string refusal(const std::string& place, const SqliteDatabase& database,
                    const std::string& what) {
  const bool is_damaged =
      !database.failure() || database.failure()->kind == SqliteFailure::Kind::kDamaged;
  return is_damaged ? damage_text(place, what) : place + " cannot be read: " + what;
}

std::string version_fault(const std::string& place, const std::string& version) {
  const std::string known = std::to_string(kLogSchemaVersion);
  if (version == known) return "";
  return place + " has version " + version + " of the format, and this program reads version " +
         known + ": use the camwayd that wrote it, or a newer one";
}

}  // namespace camway::scene
