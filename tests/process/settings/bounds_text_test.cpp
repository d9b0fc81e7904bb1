// SPDX-License-Identifier: MIT
#include "daemon/process/settings/bounds_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "daemon/messages/plan.h"
#include "tests/support/random.h"

namespace camway::process {
namespace {

using geometry::Bounds;
using ::testing::HasSubstr;

TEST(BoundsText, LeavesOutWhatIsNoLimit) {
  const Bounds bounds = *parse_bounds("-3..3/0..2.6/..");
  EXPECT_EQ(bounds.min_W.head<2>(), Eigen::Vector2d(-3, 0));
  EXPECT_EQ(bounds.max_W.head<2>(), Eigen::Vector2d(3, 2.6));
  EXPECT_EQ(bounds.min_W.z(), Bounds().min_W.z());
  EXPECT_EQ(bounds.max_W.z(), Bounds().max_W.z());
  EXPECT_EQ(bounds_text(bounds), "-3..3/0..2.6/..");
  EXPECT_EQ(*parse_bounds("../../.."), Bounds());
  EXPECT_EQ(bounds_text({}), "../../..");
}

TEST(BoundsText, FaultsQuoteWhatIsWrong) {
  for (const auto& [text, expected] : std::initializer_list<std::pair<const char*, const char*>>{
           {"", "must be X0..X1/Y0..Y1/Z0..Z1"},
           {"../..", "must be X0..X1/Y0..Y1/Z0..Z1"},
           {"../../../..", "must be X0..X1/Y0..Y1/Z0..Z1"},
           {"0.1/../..", "'0.1' must be two numbers"},
           {"../a..2/..", "'a..2' must be two numbers"},
           {"../../nan..", "'nan..' must be two numbers"},
           {"../../..inf", "'..inf' must be two numbers"},
           {"../2..1/..", "min[1] is not below max[1]"},
           {"..2e9/../..", "max[0] is more than 1e9 m"}}) {
    const base::Result<Bounds> parsed = parse_bounds(text);
    EXPECT_FALSE(parsed) << text;
    EXPECT_THAT(parsed.error, HasSubstr(expected));
  }
}

// As text and on the wire, bounds keep the same numbers for any set of limits.
TEST(BoundsText, AndTheWireKeepEveryNumber) {
  constexpr unsigned kSeed = 7;
  testing::Random random(kSeed);
  std::uniform_real_distribution<double> number(-10.0, 10.0);
  for (int trial = 0; trial < 500; ++trial) {
    Bounds bounds;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (random() % 2 == 0) bounds.min_W[axis] = number(random) - 20.0;
      if (random() % 2 == 0) bounds.max_W[axis] = number(random);
    }
    EXPECT_EQ(*parse_bounds(bounds_text(bounds)), bounds) << bounds_text(bounds);
    EXPECT_EQ(messages::from_wire(messages::to_wire(bounds)), bounds) << bounds_text(bounds);
  }
  EXPECT_FALSE(messages::from_wire(bounds_t{}).any());
}

}  // namespace
}  // namespace camway::process
