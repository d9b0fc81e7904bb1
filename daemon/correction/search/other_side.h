// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/correction/search/lattice_search.h"
#include "daemon/correction/search/lattice_ways.h"

namespace camway::correction {

/// The point of a way that is farthest from a polyline.
struct Apex {
  geometry::Vec3 place_W = geometry::Vec3::Zero();
  double away_m = 0.0;  ///< its distance from the nearest vertex of the polyline
};

/// Returns the apex of a way; one with `away_m` 0 if the polyline has all its points.
Apex apex_of(const std::vector<geometry::Vec3>& way_W, const std::vector<geometry::Vec3>& about_W);

/// Restricts the search of a second way for a ball to ways on another side of the obstacle that the
/// first way leads round: the second way avoids a ball about the apex of the first.
class OtherSide {
 public:
  /// `about_W`: points of the path as interpolated, near which a way is best. Requires that it
  /// outlives this object.
  OtherSide(const LatticeResult& first, const std::vector<geometry::Vec3>& about_W);

  /// Returns `ball` with the ball to avoid, and with limits of cost and points that are multiples
  /// of those of the first way, on coarser lattices.
  [[nodiscard]] BallMotion limited(BallMotion ball) const;

  /// Returns whether a second way leads so much farther from the path than the first that it is not
  /// worth drawing.
  [[nodiscard]] bool is_too_far(const LatticeResult& second) const;

 private:
  const std::vector<geometry::Vec3>& about_W_;
  Apex apex_;
  double first_cost_m_;
  std::size_t first_points_;
};

}  // namespace camway::correction
