// SPDX-License-Identifier: MIT
#include "daemon/record/trouble_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/support/captured_log.h"

namespace camway::record {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

class TroubleLogTest : public ::testing::Test {
 protected:
  testing::CapturedLog log_;
  TroubleLog trouble_{log_.log(), {.calm = 30s, .reminder = 600s}};
  TroubleLog::Clock::time_point now_ = TroubleLog::Clock::time_point() + 1h;
};

TEST_F(TroubleLogTest, AShortTroubleMakesTwoLines) {
  trouble_.succeeded(now_);
  EXPECT_EQ(log_.text(), "");
  trouble_.failed("full", now_);
  trouble_.lost(5, 1);
  EXPECT_THAT(log_.text(), HasSubstr("warning not all is recorded reason=full"));
  trouble_.succeeded(now_ + 1s);
  trouble_.lost(2, 0);
  trouble_.succeeded(now_ + 30s - 1ms);
  EXPECT_EQ(lines_in(log_.text()), 1U) << "it may be full again";
  EXPECT_EQ(trouble_.reason(), "full");
  trouble_.succeeded(now_ + 30s);
  EXPECT_EQ(trouble_.reason(), "");
  trouble_.succeeded(now_ + 31s);
  trouble_.finish();
  EXPECT_EQ(lines_in(log_.text()), 2U);
  EXPECT_THAT(log_.text(), HasSubstr("info the recording goes on failures=1 messages=7 changes=1"));
  log_.clear();
  trouble_.failed("full", now_ + 40s);
  trouble_.finish();
  EXPECT_THAT(log_.text(), HasSubstr("not all is recorded"));
  EXPECT_THAT(log_.text(), HasSubstr("not all was recorded failures=1 messages=0 changes=0"));
}

/// A disk that has room and is full again each second, for an hour, then has room.
TEST_F(TroubleLogTest, ADiskThatHoversAtFullMakesALineInTenMinutes) {
  for (int second = 0; second < 3600; ++second) {
    trouble_.failed("full", now_ + second * 1s);
    trouble_.lost(3, 0);
    trouble_.succeeded(now_ + second * 1s + 500ms);
    ASSERT_EQ(trouble_.reason(), "full") << second;
  }
  EXPECT_EQ(lines_in(log_.text()), 6U) << log_.text();
  EXPECT_THAT(log_.text(), Not(HasSubstr("goes on")));
  EXPECT_THAT(log_.text(),
              HasSubstr("warning still not all is recorded reason=full failures=3001"));
  log_.clear();
  for (int second = 3600; second < 7200; ++second) trouble_.succeeded(now_ + second * 1s);
  EXPECT_EQ(log_.text(), "info the recording goes on failures=3600 messages=10800 changes=0\n");
}

/// The same for one that stays full.
TEST_F(TroubleLogTest, ADiskThatStaysFullMakesALineInTenMinutes) {
  for (int second = 0; second < 3600; ++second) trouble_.failed("full", now_ + second * 1s);
  EXPECT_EQ(lines_in(log_.text()), 6U) << log_.text();
}

}  // namespace
}  // namespace camway::record
