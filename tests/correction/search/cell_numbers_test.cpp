// SPDX-License-Identifier: MIT
#include "daemon/correction/search/cell_numbers.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "tests/support/random.h"

namespace camway::correction {
namespace {

constexpr std::uint32_t kSeed = 20261122;

Cell neighbour(const Cell& cell, std::size_t step) {
  const auto i = static_cast<std::int32_t>(step);
  return {cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1};
}

TEST(CellNumbers, KeysTellCellsApartAndLeadToNeighbours) {
  testing::Random random(kSeed);
  std::uniform_int_distribution<std::int32_t> coordinate(2 - kFarthestCell, kFarthestCell - 2);
  for (int i = 0; i < 10'000; ++i) {
    const Cell cell = {coordinate(random), coordinate(random), coordinate(random)};
    EXPECT_NE(key_of(cell), 0U);
    EXPECT_EQ(cell_of(key_of(cell)), cell);
    for (std::size_t step = 0; step < kCellSteps; ++step) {
      ASSERT_EQ(cell_of(key_of(cell) + kKeySteps[step]), neighbour(cell, step));
    }
  }
}

// A walk at random, some jumps among it; the oracle is a map.
TEST(CellNumbers, AreThoseThatWereGiven) {
  testing::Random random(kSeed);
  std::uniform_int_distribution<std::int32_t> far(-kFarthestCell / 2, kFarthestCell / 2);
  std::uniform_int_distribution<std::size_t> any_step(0, kCellSteps - 1);
  CellNumbers numbers;
  std::map<Cell, std::uint32_t> given;
  Cell cell = {0, 0, 0};
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    const CellNumbers::Around around = numbers.around(cell);
    for (std::size_t step = 0; step < kCellSteps; ++step) {
      const auto known = given.find(neighbour(cell, step));
      ASSERT_EQ(around[step], known == given.end() ? CellNumbers::kNone : known->second) << i;
    }
    const std::size_t step = any_step(random);
    around[step] = i;
    given[neighbour(cell, step)] = i;
    cell = i % 100 == 99 ? Cell{far(random), far(random), far(random)} : neighbour(cell, step);
  }
}

}  // namespace
}  // namespace camway::correction
