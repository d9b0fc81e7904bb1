// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>

#include "daemon/scene/import/readers/polygon_cutter.h"

namespace camway::scene::unigrafix {

using mesh_readers::Point;
/// Rows of a 3 × 3 matrix, and an offset as fourth column.
using Affine = std::array<std::array<double, 4>, 3>;

/// The place of an instance: an affine map of points, p -> A p + b, in file units, with a bound of
/// its rounding.
class PlacementMap {
 public:
  /// The map that changes nothing.
  PlacementMap();
  static PlacementMap scaling(const Point& factors);
  static PlacementMap translation(const Point& offset);
  /// Turns about a line through the origin, counter-clockwise seen against `axis`. The angle of a
  /// multiple of 90° about an axis of coordinates is exact. Requires that `axis` is not 0.
  static PlacementMap rotation(const Point& axis, double angle_deg);
  /// Scales by `factor` along `axis`; -1 mirrors. Requires that `axis` is not 0.
  static PlacementMap scaling_along(const Point& axis, double factor);
  /// Any map.
  static PlacementMap affine(const Affine& matrix);

  /// Returns the map that applies this one first and then `next`.
  [[nodiscard]] PlacementMap then(const PlacementMap& next) const;
  [[nodiscard]] Point apply(const Point& point) const;
  /// Whether it turns the orientation of a face round.
  [[nodiscard]] bool mirrors() const;

  /// Bounds the distance, by coordinate, of `apply(p)` from the exact map of the file's numbers,
  /// for |p| at most `largest` by coordinate.
  [[nodiscard]] double rounding(const Point& largest) const;

 private:
  PlacementMap(const Affine& matrix, const Affine& magnitudes, double roundoffs);

  Affine matrix_{};
  /// Magnitudes that the rounding of `matrix_` is relative to: products of those of the factors.
  Affine magnitudes_{};
  double roundoffs_ = 0.0;  ///< of an entry, relative to its magnitude
};

}  // namespace camway::scene::unigrafix
