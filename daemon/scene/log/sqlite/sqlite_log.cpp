// SPDX-License-Identifier: MIT
#include "daemon/scene/log/sqlite/sqlite_log.h"

#include <sys/stat.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <limits>
#include <system_error>
#include <utility>

#include "daemon/scene/log/removal_requests.h"
#include "daemon/scene/log/sqlite/log_refusal.h"
#include "daemon/scene/log/sqlite/log_rows.h"
#include "daemon/scene/log/sqlite/row_digest.h"
#include "daemon/scene/log/sqlite/sqlite_schema.h"
#include "daemon/scene/log/sqlite/state_files.h"

namespace camway::scene {
namespace {

namespace fs = std::filesystem;

/// SQLite's integers have a sign.
constexpr auto kMostRevision = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());

/// The note that keeps the requests of the last removals.
constexpr std::string_view kRemovalsKey = "removals";

AppendResult broken(std::string error) { return {AppendFault::kBroken, std::move(error)}; }

/// The inode of a file; nothing if there is none.
std::optional<ino_t> inode_of(const fs::path& file) {
  struct stat status {};
  return stat(file.c_str(), &status) == 0 ? std::optional(status.st_ino) : std::nullopt;
}

/// Makes the log if it is missing. Returns why not; empty otherwise.
std::string make_missing_log(const fs::path& folder) {
  const fs::path file = folder / kLogFile;
  std::error_code failed;
  if (fs::exists(fs::symlink_status(file, failed))) return "";
  for (const char* const suffix : {"-wal", "-journal"}) {
    // SQLite would add these changes to a new log, to which they do not belong.
    if (fs::exists(file.string() + suffix, failed)) {
      return damage_text(place_of_state(folder),
                         std::string(kLogFile) + " is missing, but its recent changes are there");
    }
  }
  if (CommitCount::read(folder).value_or(0) > 0) {
    return damage_text(place_of_state(folder),
                       std::string(kLogFile) + " is missing, but changes were answered");
  }
  const base::Result<bool> made = create_log_database(file);
  return made ? "" : place_of_state(folder) + " cannot be made: " + made.error;
}

}  // namespace

base::Result<std::unique_ptr<SqliteLog>> SqliteLog::open(const fs::path& state_dir,
                                                         const SqliteLogLimits& limits) {
  // Exports find the folder even if the process goes to another one.
  const fs::path folder = fs::absolute(state_dir);
  std::string fault = make_state_folder(folder);
  if (!fault.empty()) return base::Failure{place_of_state(folder) + " cannot be made: " + fault};
  auto lock = lock_state_folder(folder);
  if (!lock) return base::Failure{std::move(lock.error)};
  fault = make_missing_log(folder);
  if (!fault.empty()) return base::Failure{std::move(fault)};
  std::unique_ptr<SqliteLog> log(new SqliteLog(folder, limits));
  log->lock_.emplace(*std::move(lock));
  fault = log->open_database(SqliteDatabase::Access::kWrite);
  if (!fault.empty()) return base::Failure{std::move(fault)};
  return log;
}

base::Result<std::unique_ptr<SqliteLog>> SqliteLog::open_read_only(const fs::path& state_dir) {
  std::unique_ptr<SqliteLog> log(new SqliteLog(fs::absolute(state_dir), {}));
  if (!fs::exists(file_of(state_dir))) {
    return base::Failure{place_of_state(log->folder_) + " is not there: no daemon has kept its " +
                         "scenes in this folder"};
  }
  std::string fault = log->open_database(SqliteDatabase::Access::kRead);
  if (!fault.empty()) return base::Failure{std::move(fault)};
  return log;
}

std::string SqliteLog::open_database(SqliteDatabase::Access access) {
  auto opened = SqliteDatabase::open(folder_ / kLogFile, access);
  if (!opened) return place_of_state(folder_) + " cannot be opened: " + opened.error;
  database_ = *std::move(opened);
  const auto version = version_of_log(*database_);
  if (!version) return refusal(place_of_state(folder_), *database_, version.error);
  std::string fault = version_fault(place_of_state(folder_), *version);
  if (!fault.empty()) return fault;
  fault = fault_of_structure(*database_, "quick_check");
  if (fault.empty()) fault = fault_of_notes(*database_);
  if (!fault.empty()) return refusal(place_of_state(folder_), *database_, fault);
  fault = fault_of_commits(folder_, *database_);
  commits_ = read_meta(*database_, "commits");
  if (!fault.empty()) return refusal(place_of_state(folder_), *database_, fault);
  highest_removed_ = read_meta(*database_, "highest_removed");
  if (access == SqliteDatabase::Access::kWrite) {
    if (!prepare_for_changes(*database_, limits_.most_bytes)) return database_fault().error;
    database_inode_ = inode_of(folder_ / kLogFile).value_or(0);
    answered_.emplace(folder_);
    if (!answered_->write(commits_) || !is_synced(folder_)) {
      return place_of_state(folder_) + " cannot be written: " + CommitCount::kFile + ": " +
             std::strerror(errno);
    }
  }
  return database_->failure() ? database_fault().error : "";
}

AppendResult SqliteLog::append(std::string_view scene, const LogEntry& entry) {
  const std::scoped_lock lock(mutex_);
  if (entry.revision <= entry.before || entry.revision > kMostRevision) {
    return broken("revision " + std::to_string(entry.revision) + " cannot follow revision " +
                  std::to_string(entry.before));
  }
  AppendResult too_large = fault_of_size(entry.record.size());
  if (too_large.fault != AppendFault::kNone) return too_large;
  const auto insert = [&] { return insert_entry(scene, entry); };
  return entry.needs.empty() ? write_beyond_limit(insert) : write(insert);
}

AppendResult SqliteLog::insert_entry(std::string_view scene, const LogEntry& entry) {
  AppendResult fault = fault_of_revision(scene, entry.before);
  if (fault.fault == AppendFault::kNone) fault = missing_need(entry.needs);
  if (fault.fault != AppendFault::kNone) return fault;
  const base::Digest::Bytes digest = entry_digest(scene, entry);
  SqliteQuery head = database_->query(
      "INSERT INTO heads(scene, revision) VALUES(?, ?) "
      "ON CONFLICT(scene) DO UPDATE SET revision=excluded.revision");
  head.with(scene).with(entry.revision);
  SqliteQuery row = database_->query(
      "INSERT INTO entries(scene, revision, before, digest, record) VALUES(?, ?, ?, ?, ?)");
  row.with(scene).with(entry.revision).with(entry.before).with(digest).with(entry.record);
  if (!head.run() || !row.run()) return database_fault();
  for (std::size_t i = 0; i < entry.needs.size(); ++i) {
    SqliteQuery need = database_->query(
        "INSERT INTO entry_needs(scene, revision, place, blob) VALUES(?, ?, ?, ?)");
    need.with(scene).with(entry.revision).with(std::uint64_t{i}).with(entry.needs[i]);
    if (!need.run()) return database_fault();
  }
  return {};
}

AppendResult SqliteLog::summarize(std::string_view scene, std::uint64_t revision,
                                  const Bytes& summary, const std::vector<BlobId>& needs) {
  const std::scoped_lock lock(mutex_);
  AppendResult too_large = fault_of_size(summary.size());
  if (too_large.fault != AppendFault::kNone) return too_large;
  return write_beyond_limit([&] { return replace_by_summary(scene, revision, summary, needs); });
}

AppendResult SqliteLog::replace_by_summary(std::string_view scene, std::uint64_t revision,
                                           const Bytes& summary, const std::vector<BlobId>& needs) {
  SqliteQuery known = database_->query(
      "SELECT 1 FROM entries WHERE scene=? AND revision=? "
      "UNION ALL SELECT 1 FROM summaries WHERE scene=? AND revision=?");
  if (!known.with(scene).with(revision).with(scene).with(revision).next()) {
    if (known.has_failed()) return database_fault();
    return {AppendFault::kConflict, "scene '" + std::string(scene) +
                                        "' has no change to revision " + std::to_string(revision)};
  }
  AppendResult missing = missing_need(needs);
  if (missing.fault != AppendFault::kNone) return missing;
  const base::Digest::Bytes digest = summary_digest(scene, revision, summary, needs);
  SqliteQuery old_entries = database_->query("DELETE FROM entries WHERE scene=? AND revision<=?");
  SqliteQuery old_summary = database_->query("DELETE FROM summaries WHERE scene=?");
  SqliteQuery insert =
      database_->query("INSERT INTO summaries(scene, revision, digest, record) VALUES(?, ?, ?, ?)");
  insert.with(scene).with(revision).with(digest).with(summary);
  if (!old_entries.with(scene).with(revision).run() || !old_summary.with(scene).run() ||
      !insert.run()) {
    return database_fault();
  }
  for (std::size_t i = 0; i < needs.size(); ++i) {
    SqliteQuery need =
        database_->query("INSERT INTO summary_needs(scene, place, blob) VALUES(?, ?, ?)");
    if (!need.with(scene).with(std::uint64_t{i}).with(needs[i]).run()) return database_fault();
  }
  return {};
}

AppendResult SqliteLog::remove(std::string_view scene, std::uint64_t revision,
                               std::string_view request) {
  const std::scoped_lock lock(mutex_);
  AppendResult result = write_beyond_limit([&] { return delete_scene(scene, revision, request); });
  if (result.fault == AppendFault::kNone) highest_removed_ = std::max(highest_removed_, revision);
  return result;
}

AppendResult SqliteLog::delete_scene(std::string_view scene, std::uint64_t revision,
                                     std::string_view request) {
  if (revision == 0) return {AppendFault::kConflict, "no scene has revision 0"};
  AppendResult fault = fault_of_revision(scene, revision);
  if (fault.fault != AppendFault::kNone) return fault;
  const std::uint64_t highest = std::max(highest_removed_, revision);
  const base::Digest::Bytes digest = meta_digest("highest_removed", highest);
  const bool is_deleted =
      // The foreign keys delete all that belongs to the scene.
      database_->query("DELETE FROM heads WHERE scene=?").with(scene).run() &&
      database_->query("UPDATE meta SET value=?, digest=? WHERE key='highest_removed'")
          .with(highest)
          .with(digest)
          .run();
  if (!is_deleted) return database_fault();
  if (request.empty()) return {};
  return write_note(kRemovalsKey, with_removal(read_note(kRemovalsKey), request));
}

std::uint64_t SqliteLog::highest_removed() {
  const std::scoped_lock lock(mutex_);
  return highest_removed_;
}

std::vector<std::string> SqliteLog::removals() { return removals_in(note(kRemovalsKey)); }

base::Result<std::vector<LoggedScene>> SqliteLog::scenes() {
  const std::scoped_lock lock(mutex_);
  database_->forget_failure();
  base::Result<std::vector<LoggedScene>> found = base::Failure{"no state can be read"};
  database_->read_at_once([&] {
    found = read_logged_scenes(*database_);
    return true;
  });
  if (!found) return base::Failure{refusal(place_of_state(folder_), *database_, found.error)};
  return found;
}

std::string SqliteLog::note(std::string_view key) {
  const std::scoped_lock lock(mutex_);
  return read_note(key);
}

std::string SqliteLog::read_note(std::string_view key) {
  SqliteQuery row = database_->query("SELECT text FROM notes WHERE key=?");
  return row.with(key).next() ? row.text(0) : "";
}

base::Result<std::map<std::string, std::string>> SqliteLog::notes(std::string_view prefix) {
  const std::scoped_lock lock(mutex_);
  database_->forget_failure();
  std::map<std::string, std::string> found;
  SqliteQuery rows = database_->query("SELECT key, text FROM notes");
  while (rows.next()) {
    if (rows.text(0).starts_with(prefix)) found.emplace(rows.text(0), rows.text(1));
  }
  if (rows.has_failed()) return base::Failure{database_fault().error};
  return found;
}

AppendResult SqliteLog::set_note(std::string_view key, std::string_view text) {
  const std::scoped_lock lock(mutex_);
  AppendResult too_large = fault_of_size(text.size());
  if (too_large.fault != AppendFault::kNone) return too_large;
  return write([&] { return write_note(key, text); });
}

AppendResult SqliteLog::write_note(std::string_view key, std::string_view text) {
  const base::Digest::Bytes digest = note_digest(key, text);
  const bool is_set =
      text.empty() ? database_->query("DELETE FROM notes WHERE key=?").with(key).run()
                   : database_->query("REPLACE INTO notes(key, text, digest) VALUES(?, ?, ?)")
                         .with(key)
                         .with(text)
                         .with(digest)
                         .run();
  return is_set ? AppendResult{} : database_fault();
}

AppendResult SqliteLog::fault_of_files() {
  const fs::path file = folder_ / kLogFile;
  const std::optional<ino_t> changes = inode_of(file.string() + "-wal");
  const bool is_same =
      inode_of(file) == database_inode_ && (!changes_inode_ || changes == changes_inode_);
  changes_inode_ = changes_inode_ ? changes_inode_ : changes;
  if (is_same) return {};
  return broken(place_of_state(folder_) +
                " cannot be written: its files were removed or replaced while it was in use");
}

AppendResult SqliteLog::count_commit() {
  return database_->query("UPDATE meta SET value=?, digest=? WHERE key='commits'")
                 .with(commits_ + 1)
                 .with(meta_digest("commits", commits_ + 1))
                 .run()
             ? AppendResult{}
             : database_fault();
}

AppendResult SqliteLog::write(const std::function<AppendResult()>& change) {
  database_->forget_failure();
  if (!answered_) return broken(place_of_state(folder_) + " is open for reading only");
  AppendResult result = fault_of_files();
  if (result.fault != AppendFault::kNone) return result;
  const bool is_written = database_->transact([&] {
    result = change();
    if (result.fault == AppendFault::kNone) result = count_commit();
    return result.fault == AppendFault::kNone;
  });
  if (!is_written) return result.fault != AppendFault::kNone ? result : database_fault();
  ++commits_;
  // The change is durable. Without this number its loss would not be noticed until the next one is
  // written; to refuse the change, though, would leave the store without what its log has.
  static_cast<void>(answered_->write(commits_));
  return result;
}

AppendResult SqliteLog::write_beyond_limit(const std::function<AppendResult()>& change) {
  AppendResult result = write(change);
  if (result.fault != AppendFault::kFull) return result;
  if (!limit_size(*database_, limits_.most_bytes + kReserveBytes)) return result;
  result = write(change);
  static_cast<void>(limit_size(*database_, limits_.most_bytes));
  return result;
}

AppendResult SqliteLog::database_fault() const {
  const std::string place = place_of_state(folder_);
  if (!database_->failure()) return broken(place + " cannot be written");
  const SqliteFailure& failure = *database_->failure();
  switch (failure.kind) {
    case SqliteFailure::Kind::kFull:
      return {AppendFault::kFull, place + " has no room left (" + failure.text +
                                      "): make room on its disk, or raise state.most_bytes, now " +
                                      std::to_string(limits_.most_bytes)};
    case SqliteFailure::Kind::kDamaged:
      return broken(damage_text(place, failure.text));
    case SqliteFailure::Kind::kOther:
      break;
  }
  return broken(place + " cannot be written: " + failure.text);
}

AppendResult SqliteLog::fault_of_size(std::size_t bytes) const {
  if (bytes <= limits_.most_blob_bytes) return {};
  return {AppendFault::kFull, place_of_state(folder_) + " holds nothing of " +
                                  std::to_string(bytes) + " bytes: an object may have " +
                                  std::to_string(limits_.most_blob_bytes)};
}

std::optional<std::uint64_t> SqliteLog::newest_revision(std::string_view scene) {
  SqliteQuery row = database_->query("SELECT revision FROM heads WHERE scene=?");
  return row.with(scene).next() ? std::optional(row.number(0)) : std::nullopt;
}

AppendResult SqliteLog::fault_of_revision(std::string_view scene, std::uint64_t expected) {
  const std::uint64_t newest = newest_revision(scene).value_or(0);
  if (database_->failure()) return database_fault();
  if (newest == expected) return {};
  if (newest == 0) {
    return {AppendFault::kConflict, "there is no scene '" + std::string(scene) + "'"};
  }
  return {AppendFault::kConflict, "scene '" + std::string(scene) + "' is at revision " +
                                      std::to_string(newest) + ", not at " +
                                      std::to_string(expected)};
}

}  // namespace camway::scene
