// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "daemon/scene/log/sqlite/log_refusal.h"
#include "daemon/scene/log/sqlite/log_rows.h"
#include "daemon/scene/log/sqlite/sqlite_log.h"
#include "daemon/scene/log/sqlite/sqlite_schema.h"
#include "daemon/scene/log/sqlite/state_files.h"

namespace camway::scene {
namespace {

namespace fs = std::filesystem;

SqliteLogContent content_of(SqliteDatabase& database, const std::vector<LoggedScene>& scenes) {
  SqliteLogContent content;
  content.scenes = scenes.size();
  for (const LoggedScene& scene : scenes) content.entries += scene.entries.size();
  SqliteQuery blobs = database.query("SELECT count(*), ifnull(sum(size), 0) FROM blobs");
  if (blobs.next()) {
    content.blobs = blobs.number(0);
    content.blob_bytes = blobs.number(1);
  }
  return content;
}

std::string fault_of_references(SqliteDatabase& database) {
  SqliteQuery found = database.query("PRAGMA foreign_key_check");
  return found.next() ? "the table " + found.text(0) + " lost the row that another row belongs to"
                      : "";
}

base::Result<SqliteLogContent> check_content(const fs::path& file, SqliteDatabase& database) {
  // An export stands alone.
  const bool is_of_folder = file.filename() == kLogFile;
  std::string fault = is_of_folder ? fault_of_commits(file.parent_path(), database) : "";
  if (fault.empty()) fault = fault_of_structure(database, "integrity_check");
  if (fault.empty()) fault = fault_of_references(database);
  if (fault.empty()) fault = fault_of_notes(database);
  if (fault.empty()) fault = fault_of_blobs(database);
  if (!fault.empty()) return base::Failure{std::move(fault)};
  const auto scenes = read_logged_scenes(database);
  if (!scenes) return base::Failure{scenes.error};
  SqliteLogContent content = content_of(database, *scenes);
  content.commits = read_meta(database, "commits");
  if (database.failure()) return base::Failure{database.failure()->text};
  return content;
}

/// Returns why a file could not be filled with a copy of another; empty otherwise.
std::string copy_log(const fs::path& from, const fs::path& to) {
  const auto source = SqliteDatabase::open(from, SqliteDatabase::Access::kRead);
  if (!source) return source.error;
  // An absolute path, since SQLite takes "file:" at the beginning of a relative one for a URI.
  const std::string target = fs::absolute(to).string();
  if (!(*source)->query("VACUUM INTO ?").with(std::string_view(target)).run()) {
    return (*source)->failure()->text;
  }
  const auto checked = SqliteLog::check(to);
  return checked ? "" : checked.error;
}

/// Makes `file` a copy of the log `from`, by the name `unfinished` until it is complete. Returns
/// why that failed; empty otherwise.
std::string copy_and_publish(const fs::path& from, const fs::path& unfinished,
                             const fs::path& file) {
  std::string fault = make_empty_file(unfinished);
  if (!fault.empty()) return fault;
  // By a connection of its own, so that changes need not wait.
  fault = copy_log(from, unfinished);
  if (fault.empty()) return publish_file(unfinished, file);
  unlink(unfinished.c_str());
  return fault;
}

}  // namespace

base::Result<SqliteLogContent> SqliteLog::check(const fs::path& file) {
  const std::string place = file.string();
  if (!fs::exists(file)) return base::Failure{place + ": there is no such file"};
  const auto opened = SqliteDatabase::open(file, SqliteDatabase::Access::kRead);
  if (!opened) return base::Failure{opened.error};
  SqliteDatabase& database = **opened;
  const auto version = version_of_log(database);
  if (!version) return base::Failure{refusal(place, database, version.error)};
  std::string fault = version_fault(place, *version);
  if (!fault.empty()) return base::Failure{std::move(fault)};
  base::Result<SqliteLogContent> content = base::Failure{"no state can be read"};
  database.read_at_once([&] {
    content = check_content(file, database);
    return true;
  });
  if (!content) return base::Failure{refusal(place, database, content.error)};
  return content;
}

std::string SqliteLog::export_to(const fs::path& file) const {
  const std::string place = "the export " + file.string() + " cannot be made: ";
  std::error_code failed;
  if (fs::exists(fs::symlink_status(file, failed))) return place + "the file is there already";
  const fs::path unfinished = file.string() + ".unfinished";
  const std::string fault = copy_and_publish(folder_ / kLogFile, unfinished, file);
  return fault.empty() ? "" : place + fault;
}

std::string SqliteLog::restore(const fs::path& file, const fs::path& state_dir) {
  const std::string place = "the folder " + state_dir.string() + " cannot be restored: ";
  const auto exported = check(file);
  if (!exported) return place + exported.error;
  std::string fault = make_state_folder(state_dir);
  if (!fault.empty()) return place + fault;
  const auto lock = lock_state_folder(state_dir);
  if (!lock) return place + lock.error;
  const fs::path target = file_of(state_dir);
  // SQLite would take files that it left beside an older log for a part of this one.
  for (const char* const end : {"", "-wal", "-shm", "-journal"}) {
    const fs::path left = target.string() + end;
    std::error_code failed;
    if (fs::exists(left, failed)) {
      return place + left.string() + " is there already; move the folder away first";
    }
  }
  const fs::path unfinished = target.string() + ".unfinished";
  // The number must be that of this log, and durable before the log is there.
  unlink((state_dir / CommitCount::kFile).c_str());
  if (!CommitCount(state_dir).write(exported->commits)) {
    return place + CommitCount::kFile + ": " + std::strerror(errno);
  }
  fault = copy_and_publish(file, unfinished, target);
  return fault.empty() ? "" : place + fault;
}

fs::path SqliteLog::file_of(const fs::path& state_dir) { return state_dir / kLogFile; }

}  // namespace camway::scene
