// SPDX-License-Identifier: MIT
#include "daemon/messages/text.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string_view>

#include <camway/plan_response_t.hpp>

#include "daemon/planning/result/result.h"

namespace camway::messages {
namespace {

TEST(MessageText, StatusesHaveTheNamesOfPlanningAndOfTheirOwn) {
  for (std::int32_t status = 0; status <= plan_response_t::STATUS_INTERNAL_ERROR; ++status) {
    EXPECT_EQ(status_name(status), planning::to_string(static_cast<planning::Status>(status)));
  }
  EXPECT_EQ(status_name(plan_response_t::STATUS_OVERLOADED), "overloaded");
  std::set<std::string_view> names;
  for (std::int32_t status = 0; status <= plan_response_t::STATUS_OLD_SCENE; ++status) {
    EXPECT_NE(status_name(status), kUnknownStatus) << status;
    EXPECT_TRUE(names.insert(status_name(status)).second) << status_name(status);
  }
  EXPECT_EQ(status_name(plan_response_t::STATUS_OLD_SCENE + 1), kUnknownStatus);
}

TEST(MessageText, LongTextsAreCutBetweenCharacters) {
  EXPECT_EQ(clipped("abcdef", 4), "abcd");
  EXPECT_EQ(clipped("abcd", 4), "abcd");
  EXPECT_EQ(clipped(std::string_view("ab\0cd", 5), 4), "ab");
  EXPECT_EQ(clipped("abc\xc3\xa4", 4), "abc");  // ä: two bytes
  EXPECT_EQ(clipped("abc\xc3\xa4", 5), "abc\xc3\xa4");
  EXPECT_EQ(clipped("\x80\x80\x80", 2), "");  // never UTF-8, still ends
}

}  // namespace
}  // namespace camway::messages
