// SPDX-License-Identifier: MIT
#include "daemon/scene/field/distance_transform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "tests/support/random.h"

namespace camway::scene {
namespace {

constexpr std::uint64_t kTransformSeed = 2012;

using Size = std::array<std::int32_t, 3>;

std::size_t count(const Size& size) {
  return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
         static_cast<std::size_t>(size[2]);
}

/// Returns complete squared distances, transformed one byte at a time.
std::vector<int> transformed(const Size& size, const std::vector<std::uint8_t>& marks,
                             unsigned threads) {
  std::vector<int> squared(marks.size());
  for (const unsigned shift : {0U, 8U}) {
    CellDistanceCodes codes;
    for (std::size_t i = 0; i < codes.size(); ++i) {
      codes[i] = static_cast<std::uint8_t>(i >> shift & 255U);
    }
    std::vector<std::uint8_t> cells = marks;
    distance_transform(size, threads, codes, cells);
    for (std::size_t i = 0; i < cells.size(); ++i) squared[i] += cells[i] << shift;
  }
  return squared;
}

struct TransformCell {
  int x, y, z;
};

TransformCell cell_of(const Size& size, std::size_t index) {
  const int i = static_cast<int>(index);
  return {i % size[0], i / size[0] % size[1], i / (size[0] * size[1])};
}

int squared_gap(int difference) {
  const int gap = std::max(std::abs(difference) - 1, 0);
  return gap * gap;
}

std::vector<int> brute_force(const Size& size, const std::vector<std::uint8_t>& marks) {
  std::vector<TransformCell> marked;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (marks[i] != 0) marked.push_back(cell_of(size, i));
  }
  std::vector<int> squared(marks.size(), kMaxSquaredCellDistance);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const TransformCell c = cell_of(size, i);
    for (const TransformCell& m : marked) {
      const int distance = squared_gap(c.x - m.x) + squared_gap(c.y - m.y) + squared_gap(c.z - m.z);
      squared[i] = std::min(squared[i], distance);
    }
  }
  return squared;
}

std::vector<std::uint8_t> random_marks(testing::Random& random, std::size_t cells,
                                       std::uint64_t one_in) {
  std::vector<std::uint8_t> marks(cells);
  for (std::uint8_t& mark : marks) mark = random() % one_in == 0 ? 1 : 0;
  return marks;
}

TEST(DistanceTransform, IsExact) {
  testing::Random random(kTransformSeed);
  for (const Size& size : {Size{1, 1, 1}, Size{7, 1, 1}, Size{1, 9, 1}, Size{1, 1, 8},
                           Size{31, 9, 6}, Size{32, 8, 7}, Size{33, 21, 5}, Size{65, 6, 30}}) {
    for (const std::uint64_t one_in : {2U, 20U, 300U, 3000U}) {
      for (int trial = 0; trial < 5; ++trial) {
        const std::vector<std::uint8_t> marks = random_marks(random, count(size), one_in);
        ASSERT_EQ(transformed(size, marks, 1), brute_force(size, marks));
      }
    }
  }
}

/// Along each axis, beyond the range of 16 bits.
TEST(DistanceTransform, StopsAtItsReach) {
  for (const Size& size : {Size{300, 2, 3}, Size{2, 300, 3}, Size{3, 2, 300}, Size{150, 150, 1}}) {
    std::vector<std::uint8_t> marks(count(size));
    EXPECT_EQ(transformed(size, marks, 1), brute_force(size, marks)) << "nothing is marked";
    marks[1] = 1;
    const std::vector<int> squared = transformed(size, marks, 1);
    EXPECT_EQ(squared, brute_force(size, marks));
    EXPECT_EQ(*std::max_element(squared.begin(), squared.end()), kMaxSquaredCellDistance);
  }
}

TEST(DistanceTransform, IsTheSameForAnyNumberOfThreads) {
  testing::Random random(kTransformSeed);
  const Size size{70, 41, 33};
  const std::vector<std::uint8_t> marks = random_marks(random, count(size), 2000);
  const std::vector<int> expected = transformed(size, marks, 1);
  for (const unsigned threads : {2U, 7U}) EXPECT_EQ(transformed(size, marks, threads), expected);
}

}  // namespace
}  // namespace camway::scene
