// SPDX-License-Identifier: MIT
#include "daemon/scene/log/sqlite/sqlite_database.h"

#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace camway::scene {
namespace {

namespace fs = std::filesystem;

/// How long a statement waits for a lock of another process, such as an administrator's `sqlite3`.
constexpr int kBusyTimeoutMs = 5000;

SqliteFailure::Kind kind_of(int code, int system_error) {
  if (system_error == ENOSPC || system_error == EDQUOT) return SqliteFailure::Kind::kFull;
  switch (code & 0xff) {
    case SQLITE_FULL:
    case SQLITE_TOOBIG:
      return SqliteFailure::Kind::kFull;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
    case SQLITE_FORMAT:
      return SqliteFailure::Kind::kDamaged;
    default:
      return code == SQLITE_IOERR_SHORT_READ ? SqliteFailure::Kind::kDamaged
                                             : SqliteFailure::Kind::kOther;
  }
}

fs::path beside(const fs::path& file, const char* suffix) { return file.string() + suffix; }

/// SQLite reads a database in WAL mode only if it can write files beside it, unless it is told that
/// nobody changes it. That is so on a medium that is read-only, where no other file is beside it.
bool is_immutable(const fs::path& file) {
  std::error_code failed;
  const fs::path folder = fs::absolute(file, failed).parent_path();
  return !failed && access(folder.c_str(), W_OK) != 0 && !fs::exists(beside(file, "-wal"), failed);
}

std::string uri_of(const fs::path& file, bool is_fixed) {
  std::string uri = "file:";
  for (const char c : file.string()) {
    if (c == '%') {
      uri += "%25";
    } else if (c == '?') {
      uri += "%3f";
    } else if (c == '#') {
      uri += "%23";
    } else {
      uri += c;
    }
  }
  return is_fixed ? uri + "?immutable=1" : uri;
}

}  // namespace

SqliteQuery::~SqliteQuery() {
  if (statement_ == nullptr) return;
  sqlite3_reset(statement_);
  sqlite3_clear_bindings(statement_);
}

SqliteQuery& SqliteQuery::with(std::uint64_t number) {
  if (statement_ != nullptr) {
    note(sqlite3_bind_int64(statement_, ++parameters_, static_cast<sqlite3_int64>(number)));
  }
  return *this;
}

SqliteQuery& SqliteQuery::with(std::string_view text) {
  if (statement_ != nullptr) {
    // A null pointer would be NULL instead of an empty text.
    const char* const begin = text.data() == nullptr ? "" : text.data();
    note(sqlite3_bind_text64(statement_, ++parameters_, begin, text.size(), SQLITE_STATIC,
                             SQLITE_UTF8));
  }
  return *this;
}

SqliteQuery& SqliteQuery::with(std::span<const std::byte> bytes) {
  if (statement_ != nullptr) {
    const void* const begin = bytes.data() == nullptr ? "" : static_cast<const void*>(bytes.data());
    note(sqlite3_bind_blob64(statement_, ++parameters_, begin, bytes.size(), SQLITE_STATIC));
  }
  return *this;
}

SqliteQuery& SqliteQuery::with(const base::Digest::Bytes& digest) {
  return with(std::as_bytes(std::span(digest)));
}

bool SqliteQuery::next() {
  if (statement_ == nullptr) has_failed_ = true;
  if (has_failed_) return false;
  const int code = sqlite3_step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) note(code);
  return false;
}

bool SqliteQuery::run() {
  while (next()) {
  }
  return !has_failed_;
}

void SqliteQuery::note(int code) {
  if (code == SQLITE_OK || has_failed_) return;
  has_failed_ = true;
  database_->note(code);
}

std::uint64_t SqliteQuery::number(int column) const {
  return static_cast<std::uint64_t>(sqlite3_column_int64(statement_, column));
}

std::string SqliteQuery::text(int column) const {
  // The text has to be asked for before its size.
  const unsigned char* const begin = sqlite3_column_text(statement_, column);
  const int size = sqlite3_column_bytes(statement_, column);
  return begin == nullptr ? "" : std::string(reinterpret_cast<const char*>(begin), size_t(size));
}

Bytes SqliteQuery::bytes(int column) const {
  const auto* const begin = static_cast<const std::byte*>(sqlite3_column_blob(statement_, column));
  const int size = sqlite3_column_bytes(statement_, column);
  return begin == nullptr ? Bytes() : Bytes(begin, begin + size);
}

bool SqliteQuery::copy_exactly(int column, std::span<std::byte> target) const {
  const void* const begin = sqlite3_column_blob(statement_, column);
  const int size = sqlite3_column_bytes(statement_, column);
  if (begin == nullptr || static_cast<std::size_t>(size) != target.size()) return false;
  std::memcpy(target.data(), begin, target.size());
  return true;
}

base::Result<std::unique_ptr<SqliteDatabase>> SqliteDatabase::open(const fs::path& file,
                                                                   Access access) {
  const bool is_writer = access == Access::kWrite;
  // The owner has a mutex of its own.
  const int flags = (is_writer ? SQLITE_OPEN_READWRITE : SQLITE_OPEN_READONLY) | SQLITE_OPEN_URI |
                    SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE;
  sqlite3* connection = nullptr;
  const std::string uri = uri_of(file, !is_writer && is_immutable(file));
  const int code = sqlite3_open_v2(uri.c_str(), &connection, flags, nullptr);
  std::unique_ptr<SqliteDatabase> database(new SqliteDatabase(connection));
  if (code != SQLITE_OK) {
    database->note(code);
    return base::Failure{file.string() + ": " + database->failure()->text};
  }
  sqlite3_busy_timeout(connection, kBusyTimeoutMs);
  // A file that was tampered with can run no code through its schema.
  sqlite3_db_config(connection, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(connection, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  if (!database->run("PRAGMA cell_size_check=ON; PRAGMA temp_store=MEMORY")) {
    return base::Failure{file.string() + ": " + database->failure()->text};
  }
  return database;
}

SqliteDatabase::~SqliteDatabase() {
  for (const auto& [sql, statement] : statements_) sqlite3_finalize(statement);
  sqlite3_close(connection_);
}

sqlite3_stmt* SqliteDatabase::prepared(std::string_view sql) {
  const auto found = statements_.find(sql);
  if (found != statements_.end()) return found->second;
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v3(connection_, sql.data(), static_cast<int>(sql.size()),
                                      SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
  if (code != SQLITE_OK) {
    note(code);
    return nullptr;
  }
  statements_.emplace(sql, statement);
  return statement;
}

SqliteQuery SqliteDatabase::query(std::string_view sql) { return {*this, prepared(sql)}; }

bool SqliteDatabase::run(const char* sql) {
  const int code = sqlite3_exec(connection_, sql, nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) note(code);
  return code == SQLITE_OK;
}

std::string SqliteDatabase::first_text(std::string_view sql) {
  SqliteQuery found = query(sql);
  return found.next() ? found.text(0) : "";
}

bool SqliteDatabase::transact(const std::function<bool()>& change) {
  if (!run("BEGIN IMMEDIATE")) return false;
  if (change() && run("COMMIT")) return true;
  roll_back();
  return false;
}

bool SqliteDatabase::read_at_once(const std::function<bool()>& read) {
  if (!run("BEGIN")) return false;
  const bool is_read = read();
  roll_back();
  return is_read;
}

void SqliteDatabase::roll_back() {
  // SQLite itself rolls back after some failures.
  if (sqlite3_get_autocommit(connection_) != 0) return;
  sqlite3_exec(connection_, "ROLLBACK", nullptr, nullptr, nullptr);
}

std::optional<Bytes> SqliteDatabase::read_bytes(const char* table, const char* column,
                                                std::uint64_t row) {
  sqlite3_blob* handle = nullptr;
  int code = sqlite3_blob_open(connection_, "main", table, column, static_cast<sqlite3_int64>(row),
                               0, &handle);
  std::optional<Bytes> bytes;
  if (code == SQLITE_OK) {
    const int size = sqlite3_blob_bytes(handle);
    bytes.emplace(static_cast<std::size_t>(size));
    code = size == 0 ? SQLITE_OK : sqlite3_blob_read(handle, bytes->data(), size, 0);
  }
  if (code != SQLITE_OK) {
    note(code);
    bytes.reset();
  }
  sqlite3_blob_close(handle);
  return bytes;
}

void SqliteDatabase::note(int code) {
  const bool is_system_error = (code & 0xff) == SQLITE_IOERR || (code & 0xff) == SQLITE_CANTOPEN;
  const int system_error = is_system_error ? sqlite3_system_errno(connection_) : 0;
  std::string text = connection_ == nullptr ? sqlite3_errstr(code) : sqlite3_errmsg(connection_);
  if (system_error != 0) text += std::string(" (") + std::strerror(system_error) + ")";
  failure_ = {kind_of(code, system_error), std::move(text)};
}

}  // namespace camway::scene
