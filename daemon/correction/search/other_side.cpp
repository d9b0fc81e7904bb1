// SPDX-License-Identifier: MIT
#include "daemon/correction/search/other_side.h"

#include <algorithm>
#include <limits>

namespace camway::correction {

namespace {

using geometry::Vec3;

// These limits are measured, and none changes what is proved: few of the ways beyond them were
// cheaper when drawn.
constexpr double kAlike = 1.25;         // cost of another way, relative to the first
constexpr double kLeastApart = 1.5;     // of another way from the apex of the first, in radii, ...
constexpr double kApartOfApex = 0.7;    // ... or as a share of the apex's distance from the path
constexpr double kFarther = 1.1;        // a way whose apex is so much farther off is not drawn
constexpr double kCoarser = 1.3;        // of its lattices: most searches find no way to be drawn
constexpr std::size_t kMorePoints = 8;  // of the search of another way, relative to the first

}  // namespace

Apex apex_of(const std::vector<Vec3>& way_W, const std::vector<Vec3>& about_W) {
  Apex apex;
  for (const Vec3& place_W : way_W) {
    double away_m = std::numeric_limits<double>::infinity();
    for (const Vec3& other_W : about_W) away_m = std::min(away_m, (place_W - other_W).norm());
    if (away_m > apex.away_m) apex = {place_W, away_m};
  }
  return apex;
}

OtherSide::OtherSide(const LatticeResult& first, const std::vector<Vec3>& about_W)
    : about_W_(about_W),
      apex_(apex_of(first.way_W, about_W)),
      first_cost_m_(first.cost_m),
      first_points_(first.points) {}

BallMotion OtherSide::limited(BallMotion ball) const {
  ball.avoided = {
      {apex_.place_W, std::max(kLeastApart * ball.radius_m, kApartOfApex * apex_.away_m)}};
  ball.max_cost_m = kAlike * first_cost_m_;
  ball.coarseness = kCoarser;
  ball.max_points = kMorePoints * first_points_;
  return ball;
}

bool OtherSide::is_too_far(const LatticeResult& second) const {
  return apex_of(second.way_W, about_W_).away_m > kFarther * apex_.away_m;
}

}  // namespace camway::correction
