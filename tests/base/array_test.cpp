// SPDX-License-Identifier: MIT
#include "daemon/base/array.h"

#include <gtest/gtest.h>

namespace camway::base {
namespace {

TEST(Array, HasTheElementsOfAVector) {
  const Array<int> array = std::vector<int>{3, 1, 2};
  EXPECT_EQ(std::vector<int>(array.begin(), array.end()), (std::vector<int>{3, 1, 2}));
  EXPECT_EQ(array.front() + 10 * array[1] + 100 * array.back(), 213);
  EXPECT_EQ(array.size(), 3U);
  EXPECT_TRUE(Array<int>().empty());
}

TEST(Array, CopiesAndMovedOnesShareTheElements) {
  Array<int> array = std::vector<int>{3, 1, 2};
  const int* const place = array.data();
  const Array<int> copy = array;
  const Array<int> moved = std::move(array);
  EXPECT_EQ(copy.data(), place);
  EXPECT_EQ(moved.data(), place);
}

TEST(Array, KeepsTheOwnerOfItsElements) {
  auto owner = std::make_shared<const std::vector<int>>(std::vector<int>{3, 1, 2});
  const std::weak_ptr<const std::vector<int>> watched = owner;
  {
    const Array<int> array(owner, std::span(*owner).subspan(1));
    owner.reset();
    EXPECT_FALSE(watched.expired());
    EXPECT_TRUE(array == Array<int>(std::vector<int>{1, 2}));
    EXPECT_FALSE(array == Array<int>(std::vector<int>{1, 3}));
    EXPECT_FALSE(array == Array<int>(std::vector<int>{1}));
  }
  EXPECT_TRUE(watched.expired());
}

}  // namespace
}  // namespace camway::base
