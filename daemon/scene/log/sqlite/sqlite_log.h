// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/file_descriptor.h"
#include "daemon/base/result.h"
#include "daemon/scene/log/scene_log.h"
#include "daemon/scene/log/sqlite/commit_count.h"
#include "daemon/scene/log/sqlite/sqlite_database.h"

namespace camway::scene {

struct SqliteLogLimits {
  /// Size of `scenes.sqlite` (setting `state.most_bytes`). Removals, summaries, and changes without
  /// new blobs may go beyond it by `SqliteLog::kReserveBytes`, so that they are possible when it is
  /// reached. SQLite's file of recent changes beside it is not counted: it is seldom larger than 64
  /// MiB and the largest blob together.
  std::uint64_t most_bytes = std::uint64_t{16} << 30;
  /// Size of one blob, record or summary. SQLite's own limit is 10^9 bytes for a whole row.
  std::size_t most_blob_bytes = 999'000'000;
};

/// How much a log holds.
struct SqliteLogContent {
  std::size_t scenes = 0;
  std::size_t entries = 0;
  std::size_t blobs = 0;
  std::uint64_t blob_bytes = 0;
  std::uint64_t commits = 0;  ///< transactions since the log was made
};

/// The log in one file of a folder, `scenes.sqlite`, by SQLite. While it is open, SQLite keeps
/// recent changes in files beside it, so only an export, or the file of a daemon that has ended, is
/// a backup. A damaged log is refused as a whole: the error says what is damaged and how to go on.
///
/// After a fault, nothing of the change is kept, reading works as before, and later changes succeed
/// as soon as the reason is gone. If the process or machine fails right after a fault, the change
/// may be there afterwards, as a whole.
class SqliteLog final : public SceneLog {
 public:
  static constexpr std::uint64_t kReserveBytes = std::uint64_t{1} << 20;

  /// Opens the log of a folder for changes. Makes the folder, with mode 0700, and the log if they
  /// are missing. Fails if another process has it open for changes, if it is damaged, or if a newer
  /// program wrote it. Reads the whole file.
  static base::Result<std::unique_ptr<SqliteLog>> open(const std::filesystem::path& state_dir,
                                                       const SqliteLogLimits& limits);
  /// Opens the log of a folder for reading, also while a process has it open for changes. All
  /// changes fail. Requires that the log is there. `highest_removed` is that of this moment.
  static base::Result<std::unique_ptr<SqliteLog>> open_read_only(
      const std::filesystem::path& state_dir);
  /// Verifies every byte of a log or an export, also one that is in use. Fails with what is
  /// damaged.
  static base::Result<SqliteLogContent> check(const std::filesystem::path& file);

  /// Writes a copy of the log, without what was dropped, into one new file, and verifies it.
  /// Changes may be made meanwhile. The file appears when it is complete and durable. Returns why
  /// that failed, also if the file is there already; empty otherwise.
  [[nodiscard]] std::string export_to(const std::filesystem::path& file) const;

  /// Puts a copy of an export into a folder that has no log, and makes the folder if it is missing.
  /// The log appears when it is complete and durable. Returns why that failed, also if another
  /// process uses the folder or the export is damaged; empty otherwise.
  [[nodiscard]] static std::string restore(const std::filesystem::path& file,
                                           const std::filesystem::path& state_dir);
  /// The file of the log of a folder.
  [[nodiscard]] static std::filesystem::path file_of(const std::filesystem::path& state_dir);

  AppendResult put_blob(const BlobId& id, const Blob& blob) override;
  [[nodiscard]] bool has_blob(const BlobId& id) override;
  base::Result<Bytes> blob(const BlobId& id) override;
  AppendResult append(std::string_view scene, const LogEntry& entry) override;
  AppendResult summarize(std::string_view scene, std::uint64_t revision, const Bytes& summary,
                         const std::vector<BlobId>& needs) override;
  AppendResult remove(std::string_view scene, std::uint64_t revision,
                      std::string_view request = {}) override;
  [[nodiscard]] std::uint64_t highest_removed() override;
  [[nodiscard]] std::vector<std::string> removals() override;
  base::Result<std::vector<LoggedScene>> scenes() override;
  /// Also empty if the note cannot be read.
  [[nodiscard]] std::string note(std::string_view key) override;
  AppendResult set_note(std::string_view key, std::string_view text) override;
  base::Result<std::map<std::string, std::string>> notes(std::string_view prefix) override;
  AppendResult drop_unused_blobs() override;

 private:
  SqliteLog(std::filesystem::path folder, const SqliteLogLimits& limits)
      : folder_(std::move(folder)), limits_(limits) {}

  /// Opens the file that is there. Returns why not.
  std::string open_database(SqliteDatabase::Access access);
  /// Returns what is wrong if the files of the log are no longer those that were opened.
  [[nodiscard]] AppendResult fault_of_files();
  AppendResult count_commit();
  /// Makes a change, all of it or nothing. `change` returns the fault that it found itself, or that
  /// of the database.
  AppendResult write(const std::function<AppendResult()>& change);
  /// The same for a change that makes room, or needs little: where the limit is reached, it may use
  /// the reserve.
  AppendResult write_beyond_limit(const std::function<AppendResult()>& change);
  [[nodiscard]] AppendResult database_fault() const;
  [[nodiscard]] AppendResult fault_of_size(std::size_t bytes) const;
  AppendResult missing_need(const std::vector<BlobId>& needs);
  bool is_there(const BlobId& id);
  std::optional<std::uint64_t> newest_revision(std::string_view scene);
  AppendResult fault_of_revision(std::string_view scene, std::uint64_t expected);

  AppendResult insert_blob(const BlobId& id, const Blob& blob);
  AppendResult insert_entry(std::string_view scene, const LogEntry& entry);
  AppendResult replace_by_summary(std::string_view scene, std::uint64_t revision,
                                  const Bytes& summary, const std::vector<BlobId>& needs);
  AppendResult delete_scene(std::string_view scene, std::uint64_t revision,
                            std::string_view request);
  std::string read_note(std::string_view key);
  AppendResult write_note(std::string_view key, std::string_view text);

  std::filesystem::path folder_;
  SqliteLogLimits limits_;
  std::optional<base::FileDescriptor> lock_;  ///< closed after the database
  std::mutex mutex_;
  std::unique_ptr<SqliteDatabase> database_;
  std::uint64_t highest_removed_ = 0;
  std::uint64_t commits_ = 0;            ///< transactions of the database
  std::optional<CommitCount> answered_;  ///< set if it is open for changes
  ino_t database_inode_ = 0;
  std::optional<ino_t> changes_inode_;  ///< of the file of recent changes, once it is there
};

}  // namespace camway::scene
