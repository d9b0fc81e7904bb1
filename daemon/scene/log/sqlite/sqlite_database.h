// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "daemon/base/digest.h"
#include "daemon/base/result.h"
#include "daemon/scene/log/scene_log.h"

struct sqlite3;
struct sqlite3_stmt;

namespace camway::scene {

/// An operation that SQLite refused.
struct SqliteFailure {
  enum class Kind : std::uint8_t {
    kFull,     ///< no room on the disk, or the limit of the file's size is reached
    kDamaged,  ///< the file holds no database, or a damaged one
    kOther,
  };
  Kind kind = Kind::kOther;
  std::string text;  ///< in SQLite's words
};

class SqliteDatabase;

/// One run of a prepared statement; the destructor makes the statement ready for the next run.
/// A statement cannot be run twice at the same time. Not thread-safe.
class SqliteQuery {
 public:
  SqliteQuery(SqliteDatabase& database, sqlite3_stmt* statement)
      : database_(&database), statement_(statement) {}
  SqliteQuery(const SqliteQuery&) = delete;
  SqliteQuery& operator=(const SqliteQuery&) = delete;
  ~SqliteQuery();

  /// Sets the next parameter. Texts and bytes are not copied: they have to outlive the query.
  SqliteQuery& with(std::uint64_t number);
  SqliteQuery& with(std::string_view text);
  SqliteQuery& with(std::span<const std::byte> bytes);
  SqliteQuery& with(const base::Digest::Bytes& digest);

  /// Steps to the next row. Returns false after the last row and after a failure.
  bool next();
  /// Steps to the end. Returns false after a failure.
  bool run();
  [[nodiscard]] bool has_failed() const { return has_failed_; }

  /// The values of a column of the row.
  [[nodiscard]] std::uint64_t number(int column) const;
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] Bytes bytes(int column) const;
  /// Returns an id or a digest. Nothing if the column has another size.
  template <typename Array>
  [[nodiscard]] std::optional<Array> array(int column) const {
    Array value;
    const auto target = std::as_writable_bytes(std::span(value));
    return copy_exactly(column, target) ? std::optional(value) : std::nullopt;
  }

 private:
  bool copy_exactly(int column, std::span<std::byte> target) const;
  void note(int code);

  SqliteDatabase* database_;
  sqlite3_stmt* statement_;  ///< null if it could not be prepared
  int parameters_ = 0;
  bool has_failed_ = false;
};

/// A connection to a database file. Statements are prepared once. Not thread-safe.
class SqliteDatabase {
 public:
  enum class Access : std::uint8_t { kRead, kWrite };

  /// Opens a file. Requires that it is there. Fails if it cannot be opened; whether it holds a
  /// database shows only when it is read.
  static base::Result<std::unique_ptr<SqliteDatabase>> open(const std::filesystem::path& file,
                                                            Access access);
  ~SqliteDatabase();
  SqliteDatabase(const SqliteDatabase&) = delete;
  SqliteDatabase& operator=(const SqliteDatabase&) = delete;

  SqliteQuery query(std::string_view sql);
  /// Runs statements that have no parameters. Returns false after a failure.
  bool run(const char* sql);
  /// Returns the first column of the first row as a text; empty after a failure.
  std::string first_text(std::string_view sql);

  /// Runs a change in a transaction, which is committed if the change returns true and rolled back
  /// otherwise. Returns whether it was committed.
  bool transact(const std::function<bool()>& change);
  /// The same for reads, which all see one state of the database.
  bool read_at_once(const std::function<bool()>& read);

  /// Reads a column of a row that has a number, without a copy in between. Nothing on failure.
  std::optional<Bytes> read_bytes(const char* table, const char* column, std::uint64_t row);

  /// The last failure since `forget_failure`; nothing if there was none.
  [[nodiscard]] const std::optional<SqliteFailure>& failure() const { return failure_; }
  void forget_failure() { failure_.reset(); }

 private:
  friend class SqliteQuery;
  explicit SqliteDatabase(sqlite3* connection) : connection_(connection) {}
  sqlite3_stmt* prepared(std::string_view sql);
  void note(int code);
  void roll_back();

  sqlite3* connection_;
  std::map<std::string, sqlite3_stmt*, std::less<>> statements_;
  std::optional<SqliteFailure> failure_;
};

}  // namespace camway::scene
