// SPDX-License-Identifier: MIT
#include "daemon/scene/import/unigrafix/placement_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "daemon/geometry/rounding.h"

namespace camway::scene::unigrafix {
namespace {

/// A number of the file becomes the nearest double.
constexpr double kReadingRoundoffs = 1.0;
/// An entry of a turn, or of a scaling along a line, is a sum of at most three terms of magnitude 1
/// (or of the factor), with unit vectors (3 roundoffs each), sine and cosine (1 each) of an angle
/// of less than 360° whose reading, reduction and conversion are off by 4 roundoffs of 2π. In all
/// less than 2π · 4 + 3 · (2 · 3 + 1 + 3) roundoffs.
constexpr double kTurnRoundoffs = 56.0;
/// A product of two maps adds four terms of two factors: 4 roundoffs (Higham 2002, section 3.1).
constexpr double kProductRoundoffs = 4.0;
/// For terms of higher order in the unit roundoff, of which a chain has few.
constexpr double kHigherOrders = 2.0;

constexpr Affine kIdentity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
/// Entries of a turn are no larger.
constexpr Affine kTurnMagnitudes = {{{1, 1, 1, 0}, {1, 1, 1, 0}, {1, 1, 1, 0}}};

Affine magnitudes_of(const Affine& matrix) {
  Affine result = matrix;
  for (auto& row : result) {
    for (double& entry : row) entry = std::abs(entry);
  }
  return result;
}

/// Applies `first`, then `second`.
Affine product(const Affine& second, const Affine& first) {
  Affine result{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = 0; k < 3; ++k) result[i][j] += second[i][k] * first[k][j];
    }
    result[i][3] += second[i][3];
  }
  return result;
}

Point unit(const Point& axis) {
  const double largest = std::max({std::abs(axis[0]), std::abs(axis[1]), std::abs(axis[2])});
  const Point scaled = {axis[0] / largest, axis[1] / largest, axis[2] / largest};
  const double length = std::hypot(scaled[0], scaled[1], scaled[2]);
  return {scaled[0] / length, scaled[1] / length, scaled[2] / length};
}

struct Turn {
  double sine = 0.0;
  double cosine = 1.0;
};

/// Exact for multiples of 90°, which buildings are made of.
Turn turn_by(double angle_deg) {
  const double reduced_deg = std::fmod(angle_deg, 360.0);
  const double quarters = reduced_deg / 90.0;
  if (quarters == std::trunc(quarters)) {
    constexpr std::array<Turn, 4> kQuarterTurns = {{{0, 1}, {1, 0}, {0, -1}, {-1, 0}}};
    return kQuarterTurns[static_cast<std::size_t>(static_cast<int>(quarters + 4.0) % 4)];
  }
  const double angle_rad = reduced_deg * (std::numbers::pi / 180.0);
  return {std::sin(angle_rad), std::cos(angle_rad)};
}

}  // namespace

PlacementMap::PlacementMap() : PlacementMap(kIdentity, kIdentity, 0.0) {}

PlacementMap::PlacementMap(const Affine& matrix, const Affine& magnitudes, double roundoffs)
    : matrix_(matrix), magnitudes_(magnitudes), roundoffs_(roundoffs) {}

PlacementMap PlacementMap::affine(const Affine& matrix) {
  return {matrix, magnitudes_of(matrix), kReadingRoundoffs};
}

PlacementMap PlacementMap::scaling(const Point& factors) {
  Affine matrix{};
  for (std::size_t i = 0; i < 3; ++i) matrix[i][i] = factors[i];
  return affine(matrix);
}

PlacementMap PlacementMap::translation(const Point& offset) {
  Affine matrix = kIdentity;
  for (std::size_t i = 0; i < 3; ++i) matrix[i][3] = offset[i];
  return affine(matrix);
}

PlacementMap PlacementMap::rotation(const Point& axis, double angle_deg) {
  const Point u = unit(axis);
  const Turn turn = turn_by(angle_deg);
  const double rest = 1.0 - turn.cosine;
  Affine matrix{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    matrix[i][i] = u[i] * u[i] * rest + turn.cosine;
    matrix[i][j] = u[i] * u[j] * rest - u[k] * turn.sine;
    matrix[j][i] = u[i] * u[j] * rest + u[k] * turn.sine;
  }
  return {matrix, kTurnMagnitudes, kTurnRoundoffs};
}

PlacementMap PlacementMap::scaling_along(const Point& axis, double factor) {
  const Point u = unit(axis);
  const double size = 1.0 + std::abs(factor);
  Affine matrix = kIdentity;
  Affine magnitudes = kTurnMagnitudes;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      matrix[i][j] += (factor - 1.0) * u[i] * u[j];
      magnitudes[i][j] *= size;
    }
  }
  return {matrix, magnitudes, kTurnRoundoffs};
}

PlacementMap PlacementMap::then(const PlacementMap& next) const {
  return {product(next.matrix_, matrix_), product(next.magnitudes_, magnitudes_),
          roundoffs_ + next.roundoffs_ + kProductRoundoffs};
}

Point PlacementMap::apply(const Point& point) const {
  Point result{};
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = matrix_[i][3];
    for (std::size_t k = 0; k < 3; ++k) result[i] += matrix_[i][k] * point[k];
  }
  return result;
}

bool PlacementMap::mirrors() const {
  const Affine& m = matrix_;
  const double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return determinant < 0.0;
}

double PlacementMap::rounding(const Point& largest) const {
  if (roundoffs_ == 0.0) return 0.0;
  double size = 0.0;
  for (const auto& row : magnitudes_) {
    size = std::max(size, row[0] * largest[0] + row[1] * largest[1] + row[2] * largest[2] + row[3]);
  }
  const double roundoffs = roundoffs_ + kProductRoundoffs + kReadingRoundoffs;
  return kHigherOrders * roundoffs * geometry::kUnitRoundoff * size;
}

}  // namespace camway::scene::unigrafix
