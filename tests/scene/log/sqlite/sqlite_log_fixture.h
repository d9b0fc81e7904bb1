// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/scene/log/sqlite/sqlite_log.h"
#include "tests/scene/log/log_samples.h"
#include "tests/support/temporary_folder.h"

namespace camway::scene {

/// A log that a test closes and opens again.
class SqliteLogTest : public ::testing::Test {
 protected:
  void SetUp() override { reopen(); }

  void reopen(const SqliteLogLimits& limits = {}) {
    log_.reset();
    auto opened = SqliteLog::open(state(), limits);
    ASSERT_TRUE(opened) << opened.error;
    log_ = *std::move(opened);
  }
  [[nodiscard]] std::filesystem::path state() const { return folder_.path() / "var" / "state"; }
  [[nodiscard]] std::filesystem::path file() const { return state() / "scenes.sqlite"; }

  void append(std::string_view scene, const LogEntry& entry) {
    const AppendResult result = log_->append(scene, entry);
    EXPECT_EQ(result.fault, AppendFault::kNone) << result.error;
  }
  void put(const SampleBlob& sample) {
    const AppendResult result = log_->put_blob(sample.id, sample.blob);
    EXPECT_EQ(result.fault, AppendFault::kNone) << result.error;
  }
  std::string scenes() {
    const auto scenes = log_->scenes();
    return scenes ? text_of_scenes(*scenes) : "error: " + scenes.error;
  }
  /// Runs statements of another program on the file of the closed log.
  void tamper(const char* sql) {
    log_.reset();
    sqlite3* connection = nullptr;
    ASSERT_EQ(sqlite3_open(file().c_str(), &connection), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(connection, sql, nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(connection);
    sqlite3_close(connection);
  }

  testing::TemporaryFolder folder_;
  std::unique_ptr<SqliteLog> log_;
};

}  // namespace camway::scene
