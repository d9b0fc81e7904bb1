// SPDX-License-Identifier: MIT
#include "daemon/scene/import/readers/decimal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/scene/import/readers/mesh_files.h"

namespace camway::scene::mesh_readers {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Decimal, IsTheNearestDouble) {
  EXPECT_EQ(parse_decimal("1000000.03"), 1000000.03);
  EXPECT_EQ(parse_decimal("+.5"), 0.5);
  EXPECT_EQ(parse_decimal("-2.E+2"), -200.0);
  // Half way between two doubles, and a little more: the last of many digits decides.
  EXPECT_EQ(parse_decimal("9007199254740993"), 9007199254740992.0);
  EXPECT_EQ(parse_decimal("9007199254740993." + std::string(400, '0') + "1"), 9007199254740994.0);
  testing::Random random(testing::kMeshSeed);
  for (int trial = 0; trial < 10'000; ++trial) {
    const double value = std::ldexp(static_cast<double>(random()) - 0x1p63,
                                    static_cast<int>(testing::below(random, 2000)) - 1000);
    ASSERT_EQ(parse_decimal(testing::decimal(value)), value) << testing::kMeshSeed;
  }
}

TEST(Decimal, ClampsWhatNoDoubleHolds) {
  EXPECT_EQ(parse_decimal("1e999"), kInfinity);
  EXPECT_EQ(parse_decimal("-1e99999999999999999999999"), -kInfinity);
  EXPECT_EQ(parse_decimal("1" + std::string(400, '0')), kInfinity);
  EXPECT_EQ(parse_decimal("0.0001e400"), kInfinity);
  EXPECT_EQ(parse_decimal("1e-999"), 0.0);
  EXPECT_TRUE(std::signbit(parse_decimal("-1e-999")));
  EXPECT_EQ(parse_decimal("0." + std::string(400, '0') + "1"), 0.0);
  EXPECT_EQ(parse_decimal("12345e-99999999999999999999"), 0.0);
  EXPECT_EQ(parse_decimal("nan") == 0.0, false);
  EXPECT_EQ(parse_decimal("-inf"), -kInfinity);
}

TEST(Decimal, OfAnythingElseIsNoNumber) {
  for (const char* text :
       {"", "-", "+", "+-1", "--1", ".", "e5", "1e", "1,5", "1.5x", "0x10", "1e5.", " 1", "1 "}) {
    EXPECT_TRUE(std::isnan(parse_decimal(text))) << text;
  }
  for (const char* text : {"", "-", "1.0", "1/2", "99999999999999999999", "+-1"}) {
    EXPECT_FALSE(parse_integer(text)) << text;
  }
  EXPECT_EQ(parse_integer("+12"), 12);
  EXPECT_EQ(parse_integer("-3"), -3);
}

}  // namespace
}  // namespace camway::scene::mesh_readers
