// SPDX-License-Identifier: MIT
#include "daemon/scene/import/common/transform_chain.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/random.h"

namespace camway::scene::import_process {
namespace {

constexpr std::uint64_t kChainSeed = 7117;

using Matrix = std::array<std::array<double, 4>, 4>;

template <class Number>
std::array<std::array<Number, 4>, 4> product(const std::array<std::array<Number, 4>, 4>& a,
                                             const std::array<std::array<Number, 4>, 4>& b) {
  std::array<std::array<Number, 4>, 4> result{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = 0; k < 4; ++k) result[i][j] += a[i][k] * b[k][j];
    }
  }
  return result;
}

TEST(TransformChain, BoundsTheRoundingOfAChainInFloats) {
  testing::Random random(kChainSeed);
  double closest = 0.0;
  for (int trial = 0; trial < 2000; ++trial) {
    TransformChain chain;
    std::array<std::array<float, 4>, 4> in_floats{};
    Matrix in_doubles{};
    for (std::size_t i = 0; i < 4; ++i) in_floats[i][i] = 1.0F;
    for (std::size_t i = 0; i < 4; ++i) in_doubles[i][i] = 1.0;
    for (int link = random.integer(1, 6); link-- > 0;) {
      Matrix wide{};
      std::array<std::array<float, 4>, 4> narrow{};
      Magnitudes sizes{};
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
          wide[i][j] = i == 3 ? (j == 3 ? 1.0 : 0.0) : random.uniform(-1.0, 1.0);
          if (i < 3 && j == 3) wide[i][j] *= random.log_uniform(1.0, 1e6);
          narrow[i][j] = static_cast<float>(wide[i][j]);
          sizes[i][j] = std::abs(static_cast<double>(narrow[i][j]));
        }
      }
      in_floats = product(in_floats, narrow);
      in_doubles = product(in_doubles, wide);
      chain = chain.then(sizes);
    }
    const std::array<double, 3> largest = {1.0, 2.0, 3.0};
    for (std::size_t i = 0; i < 3; ++i) {
      double exact = in_doubles[i][3];
      float rounded = in_floats[i][3];
      for (std::size_t k = 0; k < 3; ++k) {
        exact += in_doubles[i][k] * largest[k];
        rounded += in_floats[i][k] * static_cast<float>(largest[k]);
      }
      const double error = std::abs(exact - static_cast<double>(rounded));
      ASSERT_LE(error, chain.rounding(largest));
      closest = std::max(closest, error / chain.rounding(largest));
    }
  }
  EXPECT_GT(closest, 1e-3) << "the bound is of no use";
}

TEST(TransformChain, OfNoTransformRoundsNothing) {
  EXPECT_EQ(TransformChain().rounding({1e9, 1.0, 1.0}), 0.0);
}

}  // namespace
}  // namespace camway::scene::import_process
