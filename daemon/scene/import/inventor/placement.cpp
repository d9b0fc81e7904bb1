// SPDX-License-Identifier: MIT
#include "daemon/scene/import/inventor/placement.h"

#include <Inventor/SbMatrix.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace camway::scene::inventor {

Placement::Placement(const SbMatrix& matrix) : matrix_() {
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      matrix_[i][j] = static_cast<double>(matrix[static_cast<int>(i)][j]);
    }
  }
}

Point Placement::apply(const Point& point) const {
  const std::array<double, 4> moved =
      apply(std::array<double, 4>{point[0], point[1], point[2], 1.0});
  // Coin divides by the last number, which a MatrixTransform can make other than 1.
  if (moved[3] == 1.0) return {moved[0], moved[1], moved[2]};
  return {moved[0] / moved[3], moved[1] / moved[3], moved[2] / moved[3]};
}

std::array<double, 4> Placement::apply(const std::array<double, 4>& point) const {
  std::array<double, 4> moved{};
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < 4; ++i) moved[k] += point[i] * matrix_[i][k];
  }
  return moved;
}

bool Placement::mirrors() const {
  const auto& m = matrix_;
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) <
         0.0;
}

double Placement::stretch() const {
  // The square of the 2-norm of A is the largest eigenvalue of A A^T, which no sum of magnitudes
  // of one of its rows is below. For a rotation and one scale the sum is the eigenvalue.
  double largest = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < 3; ++j) {
      double entry = 0.0;
      for (std::size_t k = 0; k < 3; ++k) entry += matrix_[i][k] * matrix_[j][k];
      sum += std::abs(entry);
    }
    largest = std::max(largest, sum);
  }
  return std::sqrt(largest);
}

import_process::Magnitudes Placement::magnitudes() const {
  import_process::Magnitudes result{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) result[j][i] = std::abs(matrix_[i][j]);
  }
  return result;
}

import_process::Magnitudes magnitudes_of(const SbMatrix& matrix) {
  return Placement(matrix).magnitudes();
}

}  // namespace camway::scene::inventor
