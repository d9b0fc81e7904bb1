// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/centering.h"

#include <algorithm>
#include <array>

#include "daemon/correction/narrow/near_pairs.h"

namespace camway::correction {

namespace {

using geometry::Vec3;
using motion::Pose;

/// A change of a pose: the move of the centre, and the rotation vector times the radius of the
/// ball. [Units: metres]
using Twist = Eigen::Matrix<double, 6, 1>;

// Chosen by measurement; none changes what is proved.
constexpr int kMostCenterings = 16;   // of one centring
constexpr int kMostTwistSweeps = 40;  // of the solver, over all pairs
constexpr double kFirstGain = 0.5;    // gain asked of a step, relative to the gap
constexpr double kLeastGain = 0.02;   // the same: less is not worth a step
constexpr double kMoreGain = 1.5;     // growth of the gain that is asked of the next step
constexpr double kGainReached = 0.3;  // share of the gain asked for with which a step is taken
constexpr double kLeastAsked = 3e-5;  // gain asked of a step from contact, in radii of the ball
constexpr double kPairHorizon = 5.0;  // of pairs, relative to the gap
constexpr double kLeastPairHorizon = 0.03;  // the same, in radii of the ball
constexpr double kMostTwist = 10.0;         // length of a step, relative to the gain asked for
constexpr std::array<double, 5> kFirstScales = {0.95, 0.9, 0.8, 0.65, 0.5};
constexpr double kGrowthOfGap = 0.8;  // share of the gap that growth may take
constexpr int kMostGrowths = 60;
constexpr double kLeastGrowth = 2e-4;  // of the scale: less than that is none

/// How a pair's gap grows with a twist about the centre of the body at `pose`.
Twist gradient(const FreeSpace& space, const NearPair& pair, const Pose& pose,
               const Vec3& along_W) {
  Twist row = Twist::Zero();
  row.head<3>() = pair.away_W - pair.away_W.dot(along_W) * along_W;
  if (space.may_turn()) {
    const Vec3 lever_W = pair.at_W - space.center_W(pose);
    row.tail<3>() = lever_W.cross(pair.away_W) / space.ball_radius_m();
  }
  return row;
}

/// About the shortest twist with which all pairs have the gap `wanted_m` to first order, by
/// Hildreth's method (`contact_qp.h`).
Twist shortest_twist(const std::vector<NearPair>& pairs, const std::vector<Twist>& rows,
                     double wanted_m) {
  Twist twist = Twist::Zero();
  std::vector<double> forces(pairs.size(), 0.0);
  for (int sweep = 0; sweep < kMostTwistSweeps; ++sweep) {
    bool any = false;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double square = rows[i].squaredNorm();
      if (!(square > 0.0)) continue;
      const double missing_m = wanted_m - pairs[i].gap_m - rows[i].dot(twist);
      const double force = std::max(0.0, forces[i] + missing_m / square);
      if (force == forces[i]) continue;
      twist += (force - forces[i]) * rows[i];
      forces[i] = force;
      any = true;
    }
    if (!any) break;
  }
  return twist;
}

Pose twisted(const FreeSpace& space, const Pose& pose, const Twist& twist) {
  const Vec3 turn = twist.tail<3>() / space.ball_radius_m();
  const double angle_rad = turn.norm();
  geometry::Quat orientation = pose.orientation;
  if (angle_rad > 0.0) {
    orientation = geometry::Quat(Eigen::AngleAxisd(angle_rad, turn / angle_rad)) * orientation;
    orientation.normalize();
  }
  return space.pose_around(space.center_W(pose) + twist.head<3>(), orientation);
}

}  // namespace

Centered centered(FreeSpace& space, const Pose& pose, double enough_m, const Vec3& along_W,
                  const base::Deadline& deadline) {
  const double radius_m = space.ball_radius_m();
  const auto gap_m = [&](const Pose& at) { return space.gap_m(at, enough_m); };
  Centered now{pose, gap_m(pose)};
  double gain = kFirstGain;
  for (int i = 0; i < kMostCenterings && now.gap_m < enough_m && gain > kLeastGain; ++i) {
    if (deadline.passed()) break;
    const double horizon_m = std::max(kPairHorizon * now.gap_m, kLeastPairHorizon * radius_m);
    const std::vector<NearPair> pairs = near_pairs(space, now.pose, horizon_m);
    if (pairs.empty()) break;
    std::vector<Twist> rows;
    for (const NearPair& pair : pairs) rows.push_back(gradient(space, pair, now.pose, along_W));
    for (; gain > kLeastGain; gain *= 0.5) {
      const double asked_m = gain * std::max(now.gap_m, kLeastAsked * radius_m);
      Twist twist = shortest_twist(pairs, rows, now.gap_m + asked_m);
      const double length_m = twist.norm();
      if (length_m > kMostTwist * asked_m) twist *= kMostTwist * asked_m / length_m;
      const Pose next = twisted(space, now.pose, twist);
      const double next_m = gap_m(next);
      if (next_m < now.gap_m + kGainReached * asked_m) continue;
      now = {next, next_m};
      gain = std::min(1.0, kMoreGain * gain);
      break;
    }
  }
  return now;
}

/// A copy of the body that is scaled down, and its free space.
struct Fitter::Thin {
  Thin(const FreeSpace& whole, double scale_of_body)
      : scale(scale_of_body),
        body(whole.body().scaled(whole.center_C(), scale_of_body)),
        space({whole.obstacles(), body, whole.detect_options()}, whole.policy(),
              whole.closeness()) {}

  double scale;
  motion::Body body;
  FreeSpace space;
};

Fitter::Fitter(FreeSpace& space, const base::Deadline& deadline)
    : space_(space), deadline_(deadline), thin_(kFirstScales.size()) {}

Fitter::~Fitter() = default;

double Fitter::free_scale(const Pose& place) {
  if (space_.is_free(place, 0.0)) return 1.0;
  for (std::size_t i = 0; i < thin_.size() && !deadline_.passed(); ++i) {
    if (!thin_[i]) thin_[i] = std::make_unique<Thin>(space_, kFirstScales[i]);
    if (thin_[i]->space.is_free(place, 0.0)) return thin_[i]->scale;
  }
  return 0.0;
}

std::optional<Centered> Fitter::fitted(const Pose& place) {
  double scale = free_scale(place);
  if (scale == 0.0) return std::nullopt;
  const double radius_m = space_.ball_radius_m();
  Centered now{place, 0.0};
  for (int i = 0; i < kMostGrowths && !deadline_.passed(); ++i) {
    const bool is_whole = scale == 1.0;
    std::optional<Thin> thin;
    if (!is_whole) thin.emplace(space_, scale);
    now = centered(is_whole ? space_ : thin->space, now.pose, radius_m, Vec3::Zero(), deadline_);
    if (is_whole) return now.gap_m > 0.0 ? std::optional(now) : std::nullopt;
    const double growth = kGrowthOfGap * now.gap_m / radius_m;
    if (growth < kLeastGrowth && scale + growth < 1.0) return std::nullopt;
    scale = std::min(1.0, scale + growth);
  }
  return std::nullopt;
}

}  // namespace camway::correction
