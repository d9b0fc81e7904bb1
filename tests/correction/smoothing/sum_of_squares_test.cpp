// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/sum_of_squares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include <Eigen/Cholesky>

#include "tests/support/gap_problems.h"

namespace camway::correction {
namespace {

using testing::Draw;

// Sums of some hundred products of numbers up to 10, and divisions by pivots of 0.1 and more.
constexpr double kSumRounding = 1e-10;

/// A square: its weight, and a point that depends on up to four variables, at most `kBand` apart.
struct Square {
  double weight;
  Terms terms;
  StackedPoint constant;
};

StackedPoint random_point(Draw& draw) { return draw.points(1, 1.0).row(0).transpose(); }

/// Squares that fix each of `count` variables, so that their sum has one minimum.
std::vector<Square> random_squares(Draw& draw, int count) {
  std::vector<Square> squares;
  for (int i = 0; i < count; ++i) {
    squares.push_back({draw.uniform(0.1, 3.0), {{i, 1.0}}, random_point(draw)});
  }
  for (int i = 0; i < 3 * count; ++i) {
    const int first = draw.integer(0, count - 1);
    const int last = std::min(count - 1, first + static_cast<int>(kBand));
    Square square{draw.uniform(0.1, 3.0), {}, random_point(draw)};
    // Backwards as well: terms have no order.
    for (int k = last; k >= first; --k) square.terms.push_back({k, draw.uniform(-1.0, 1.0)});
    squares.push_back(std::move(square));
  }
  return squares;
}

SumOfSquares sum_of(const std::vector<Square>& squares, int count) {
  SumOfSquares sum(count);
  for (const Square& square : squares) sum.count(square.weight, square.terms, square.constant);
  return sum;
}

TEST(SumOfSquares, IsTheSumOfItsSquares) {
  Draw draw(4201);
  for (int count = 1; count <= 30; ++count) {
    const std::vector<Square> squares = random_squares(draw, count);
    const SumOfSquares sum = sum_of(squares, count);
    const StackedPoints variables = draw.points(count, 2.0);
    double expected = 0.0;
    for (const Square& square : squares) {
      const StackedPoint point = square.constant + combined(square.terms, variables);
      expected += 0.5 * square.weight * point.squaredNorm();
    }
    ASSERT_NEAR(sum.value(variables), expected, kSumRounding * expected) << count << " variables";
  }
}

// The oracle is Eigen's factorisation of the whole matrix.
TEST(BandFactors, SolveAsDenseFactorsDo) {
  Draw draw(4202);
  for (int count = 1; count <= 30; ++count) {
    const SumOfSquares sum = sum_of(random_squares(draw, count), count);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(count, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      for (Eigen::Index d = 0; d <= std::min(i, kBand); ++d) {
        dense(i, i - d) = dense(i - d, i) = sum.hessian(i, d);
      }
    }
    const StackedPoints expected = dense.llt().solve(sum.slope);
    StackedPoints solved = sum.slope;
    BandFactors(sum.hessian).solve_in_place(solved);
    ASSERT_LT((solved - expected).norm(), kSumRounding * (1.0 + expected.norm()))
        << count << " variables";
  }
}

}  // namespace
}  // namespace camway::correction
