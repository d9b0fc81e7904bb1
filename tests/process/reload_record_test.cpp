// SPDX-License-Identifier: MIT
#include "daemon/process/reload_record.h"

#include <gtest/gtest.h>

#include <string>

#include "lcmtypes/wire/layout.h"

namespace camway::process {
namespace {

status_t status_of(const ReloadRecord& record) {
  status_t status{};
  record.add_to(status);
  return status;
}

TEST(ReloadRecord, SaysNothingBeforeTheFirstFailure) {
  ReloadRecord record;
  record.succeeded();
  const status_t status = status_of(record);
  EXPECT_EQ(status.failed_reloads, 0);
  EXPECT_EQ(status.failed_reload_utime, 0);
  EXPECT_EQ(status.failed_reload, "");
  EXPECT_EQ(status.reload_failed, 0);
}

TEST(ReloadRecord, KeepsTheLastFailure) {
  ReloadRecord record;
  record.failed(5, "one");
  record.failed(7, "another");
  EXPECT_EQ(status_of(record).failed_reloads, 2);
  EXPECT_EQ(status_of(record).failed_reload_utime, 7);
  EXPECT_EQ(status_of(record).failed_reload, "another");
  EXPECT_EQ(status_of(record).reload_failed, 1);
  record.succeeded();
  EXPECT_EQ(status_of(record).reload_failed, 0);
  EXPECT_EQ(status_of(record).failed_reload, "another");
}

TEST(ReloadRecord, CutsALongReasonBetweenCharacters) {
  ReloadRecord record;
  record.failed(1, std::string(wire::kMaxReloadFaultBytes, 'a'));
  EXPECT_EQ(status_of(record).failed_reload.size(), wire::kMaxReloadFaultBytes);
  const std::string before(wire::kMaxReloadFaultBytes - 1, 'a');
  record.failed(1, before + "\u00e4b");
  EXPECT_EQ(status_of(record).failed_reload, before);
}

}  // namespace
}  // namespace camway::process
