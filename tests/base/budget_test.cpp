// SPDX-License-Identifier: MIT
#include "daemon/base/budget.h"

#include <gtest/gtest.h>

namespace camway::base {
namespace {

TEST(Budget, CoversWhatIsLeftAndNoMore) {
  Budget budget(3);
  budget.spend(1);
  EXPECT_EQ(budget.left(), 2);
  EXPECT_TRUE(budget.covers(2));
  EXPECT_FALSE(budget.covers(3));
}

TEST(Budget, IsOverdrawnOnlyByMoreThanThereWas) {
  Budget budget(2);
  budget.spend(2);
  EXPECT_FALSE(budget.is_overdrawn());
  EXPECT_TRUE(budget.covers(0));
  budget.spend(1);
  EXPECT_TRUE(budget.is_overdrawn());
  EXPECT_FALSE(budget.covers(0));
}

TEST(Budget, APartIsTakenOutAndItsRestPutBack) {
  Budget budget(10);
  Budget part = budget.take(4);
  EXPECT_EQ(part.left(), 4);
  EXPECT_EQ(budget.left(), 6);
  part.spend(3);
  budget.put_back(part);
  EXPECT_EQ(budget.left(), 7);
}

TEST(Budget, GivesNoMoreThanThereIs) {
  Budget budget(2);
  EXPECT_EQ(budget.take(5).left(), 2);
  EXPECT_EQ(budget.take(5).left(), 0);
  budget.spend(1);
  EXPECT_EQ(budget.take(5).left(), 0);
  EXPECT_EQ(budget.left(), -1);
}

}  // namespace
}  // namespace camway::base
