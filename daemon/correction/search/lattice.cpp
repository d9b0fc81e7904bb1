// SPDX-License-Identifier: MIT
#include "daemon/correction/search/lattice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace camway::correction {

namespace {

using geometry::Vec3;

constexpr double kEndReach = 1.8;  // steps to the end that is tried: over the diagonal of a cell
constexpr double kFarAway = 4.0;   // steps from the preferred way beyond which the cost is constant
constexpr double kStray = 0.15;    // relative extra cost of a step there
constexpr double kComfort = 0.5;   // share of the ball: gap from which a point is not near
constexpr double kHorizon = 0.9;   // share of a step: two gaps exceed the longest diagonal

}  // namespace

Lattice::Lattice(const FreeSpace& space, const Vec3& from_W, const Vec3& to_W,
                 const LatticeOptions& options)
    : space_(space),
      from_W_(from_W),
      to_W_(to_W),
      options_(options),
      comfort_m_(kComfort * options.ball_radius_m),
      horizon_m_(std::max(kHorizon * options.spacing_m, comfort_m_)) {
  for (std::size_t i = 1; i < options.about_W.size(); ++i) {
    legs_.emplace_back(options.about_W[i - 1], options.about_W[i]);
  }
}

double Lattice::rest_m(CellKey key) const {
  const Vec3 away = (place_W(key) - to_W_).cwiseAbs();
  const double less = std::min(away[0], away[1]);
  const double more = std::max(away[0], away[1]);
  const double middle = std::max(less, std::min(more, away[2]));
  const double length_m = std::max(more, away[2]) + (std::numbers::sqrt2 - 1.0) * middle +
                          (std::numbers::sqrt3 - std::numbers::sqrt2) * std::min(less, away[2]);
  return kLatticeGreed * length_m;
}

Lattice::Surroundings Lattice::about(const Vec3& place_W) const {
  Surroundings found{is_avoided(place_W) ? 0.0 : gap_m(place_W)};
  found.near = std::max(0.0, 1.0 - found.gap_m / comfort_m_);
  if (legs_.empty()) return found;
  const double far_m = kFarAway * options_.spacing_m;
  double away_m2 = far_m * far_m;
  for (const Leg& leg : legs_) away_m2 = std::min(away_m2, leg.squared_distance_m2(place_W));
  found.stray = kStray * std::sqrt(away_m2) / far_m;
  return found;
}

bool Lattice::step_is_free(const Vec3& a_W, double gap_a_m, const Vec3& b_W, double gap_b_m) const {
  if ((a_W - b_W).norm() <= sure_gap_m(gap_a_m) + sure_gap_m(gap_b_m)) return true;
  return space_.ball_passes(a_W, b_W, options_.ball_radius_m, met_);
}

bool Lattice::meets_end(const Vec3& place_W, double gap_m) const {
  const double reach_m = kEndReach * options_.spacing_m;
  return (place_W - to_W_).norm() <= reach_m &&
         step_is_free(place_W, gap_m, to_W_, this->gap_m(to_W_));
}

double Lattice::Leg::squared_distance_m2(const Vec3& place_W) const {
  const Vec3 there_W = place_W - from_W;
  const double share = square_m2 > 0.0 ? along_W.dot(there_W) / square_m2 : 0.0;
  return (std::clamp(share, 0.0, 1.0) * along_W - there_W).squaredNorm();
}

double Lattice::gap_m(const Vec3& point_W) const {
  return space_.ball_gap_m(point_W, options_.ball_radius_m, horizon_m_);
}

double Lattice::sure_gap_m(double gap_m) const {
  if (gap_m >= horizon_m_) return horizon_m_;  // nothing was met
  const double keep_m = options_.ball_radius_m + space_.query().required_clearance_m();
  return FreeSpace::kBallShare * (gap_m + keep_m) - keep_m;
}

bool Lattice::is_avoided(const Vec3& place_W) const {
  return std::ranges::any_of(options_.avoided, [&](const AvoidedBall& ball) {
    return (place_W - ball.center_W).norm() < ball.radius_m;
  });
}

}  // namespace camway::correction
