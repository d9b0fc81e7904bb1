// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "daemon/scene/log/sqlite/sqlite_log.h"
#include "tests/scene/log/log_comparison.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace camway::scene {
namespace {

constexpr std::uint64_t kLogModelSeed = 20240611;

TEST(SqliteLogModel, KeepsWhatAModelInMemoryKeeps) {
  const testing::TemporaryFolder folder;
  LogComparison comparison({kLogModelSeed, [&]() -> std::unique_ptr<SceneLog> {
                              auto opened = SqliteLog::open(folder.path(), {});
                              EXPECT_TRUE(opened) << opened.error;
                              return opened ? *std::move(opened) : nullptr;
                            }});
  for (int i = 0; i < testing::runs(1200); ++i) {
    SCOPED_TRACE("step " + std::to_string(i));
    comparison.step();
    if (i % 10 == 0) comparison.compare();
    if (::testing::Test::HasFatalFailure()) return;
  }
  comparison.reopen();
  comparison.compare();
  const auto checked = SqliteLog::check(folder.path() / "scenes.sqlite");
  EXPECT_TRUE(checked) << checked.error;
}

}  // namespace
}  // namespace camway::scene
