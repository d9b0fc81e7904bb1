// SPDX-License-Identifier: MIT
#include "daemon/base/result.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <type_traits>

namespace camway::base {
namespace {

Result<int> digit(char c) {
  if (c < '0' || c > '9') return Failure{std::string("'") + c + "' is no digit"};
  return c - '0';
}

TEST(Result, HoldsAValueOrTheReasonWhyThereIsNone) {
  const Result<int> good = digit('7');
  ASSERT_TRUE(good);
  EXPECT_EQ(*good, 7);
  EXPECT_EQ(good.value, 7);
  EXPECT_EQ(good.error, "");
  const Result<int> bad = digit('x');
  EXPECT_FALSE(bad);
  EXPECT_FALSE(bad.value);
  EXPECT_EQ(bad.error, "'x' is no digit");
}

TEST(Result, ATextIsAValueAndAFailureIsNot) {
  const Result<std::string> text = std::string("well");
  ASSERT_TRUE(text);
  EXPECT_EQ(*text, "well");
  EXPECT_EQ(text->size(), 4U);
  EXPECT_FALSE(Result<std::string>(Failure{"ill"}));
}

TEST(Result, AFailureIsPassedOnToAnotherType) {
  const Result<int> bad = digit('x');
  const Result<std::string> passed_on = Failure{bad.error};
  EXPECT_EQ(passed_on.error, bad.error);
}

TEST(Result, AValueThatIsNothingIsAValue) {
  const Result<std::optional<int>> nothing = std::optional<int>();
  ASSERT_TRUE(nothing);
  EXPECT_FALSE(nothing->has_value());
}

TEST(Result, AValueMovesOut) {
  Result<std::unique_ptr<int>> made = std::make_unique<int>(7);
  *made = std::make_unique<int>(8);
  const std::unique_ptr<int> taken = *std::move(made);
  EXPECT_EQ(*taken, 8);
}

TEST(Result, ThereIsNoneWithoutValueAndReason) {
  EXPECT_FALSE(std::is_default_constructible_v<Result<int>>);
  EXPECT_FALSE((std::is_convertible_v<Result<int>, bool>));
}

}  // namespace
}  // namespace camway::base
