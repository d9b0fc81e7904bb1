// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "daemon/scene/import/common/transform_chain.h"
#include "daemon/scene/import/readers/polygon_cutter.h"

class SbMatrix;

namespace camway::scene::inventor {

using mesh_readers::Point;

/// Where a shape is in the scene: Coin's matrix in doubles, which multiplies points as rows.
class Placement {
 public:
  explicit Placement(const SbMatrix& matrix);

  [[nodiscard]] Point apply(const Point& point) const;
  /// Takes and returns a point with its weight, (w x, w y, w z, w).
  [[nodiscard]] std::array<double, 4> apply(const std::array<double, 4>& point) const;
  [[nodiscard]] bool mirrors() const;
  /// Bound of how much the placement stretches a length.
  [[nodiscard]] double stretch() const;
  [[nodiscard]] import_process::Magnitudes magnitudes() const;

 private:
  std::array<std::array<double, 4>, 4> matrix_;  ///< by rows
};

/// The magnitudes of a matrix of Coin's.
import_process::Magnitudes magnitudes_of(const SbMatrix& matrix);

}  // namespace camway::scene::inventor
