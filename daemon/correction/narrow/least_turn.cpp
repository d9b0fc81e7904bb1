// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/least_turn.h"

#include <algorithm>
#include <array>
#include <utility>

#include "daemon/correction/narrow/centering.h"
#include "daemon/correction/narrow/hole_motion.h"

namespace camway::correction {

namespace {

using geometry::Quat;
using geometry::Vec3;
using motion::Pose;
using motion::SignedPose;

// Chosen by measurement; none changes what is proved.
/// Shares of the time at which the interpolated path has the orientations that are tried: the
/// middle first, where a way through the narrow place most likely is.
constexpr std::array<double, 7> kShares = {0.5, 0.375, 0.625, 0.25, 0.75, 0.125, 0.875};
constexpr std::array<double, 3> kSharesOfTurns = {0.5, 0.25, 0.75};
constexpr std::array<double, 5> kSharesOfGrowth = {0.5, 0.3, 0.7, 0.1, 0.9};
constexpr std::array<double, 7> kTurns_rad = {0.15, 0.25, 0.35, 0.5, 0.7, 0.9, 1.1};
constexpr double kMostOfTurn = 0.8;  // largest share of a turn by which another may replace it
constexpr int kBisections = 4;
constexpr double kHardlyTurned_rad = 0.05;  // a turn that is not worth making smaller
constexpr double kTurnedFar_rad = 0.3;      // a turn from which on others are tried

}  // namespace

LeastTurn::LeastTurn(FreeSpace& space, const SignedPose& from, const SignedPose& to,
                     std::span<const Pose> interpolated, double margin_m,
                     const base::Deadline& deadline)
    : space_(space),
      from_(from),
      to_(to),
      interpolated_(interpolated),
      margin_m_(margin_m),
      deadline_(deadline) {}

std::optional<Guide> LeastTurn::unturned(const LinePlace& place) {
  for (const double share : kShares) {
    if (deadline_.passed()) return std::nullopt;
    std::optional<Guide> found = straight(place, pose_at_share(interpolated_, share).orientation);
    if (found) return found;
  }
  return std::nullopt;
}

Guide LeastTurn::reduced(const LinePlace& place, Guide found) {
  Guide best = turned_back(place, std::move(found));
  if (turn_rad(best) <= kTurnedFar_rad) return best;
  std::optional<Guide> other = turned_little(place, kMostOfTurn * turn_rad(best));
  other = other ? turned_back(place, *std::move(other)) : grown(place);
  return other && turn_rad(*other) < turn_rad(best) ? *std::move(other) : best;
}

Guide LeastTurn::turned_back(const LinePlace& place, Guide found) {
  const Quat turned = geometry::from_wxyz(found.front().orientation);
  const Quat unturned = nearest(turned);
  if (turned.angularDistance(unturned) <= kHardlyTurned_rad) return found;
  double fits = 0.0;  // share of the way back to the interpolated path
  double fails = 1.0;
  for (int i = 0; i < kBisections && !deadline_.passed(); ++i) {
    const double share = 0.5 * (fits + fails);
    std::optional<Guide> less = straight(place, turned.slerp(share, unturned));
    (less ? fits : fails) = share;
    if (less) found = *std::move(less);
  }
  return found;
}

std::optional<Guide> LeastTurn::turned_little(const LinePlace& place, double most_rad) {
  for (const double angle_rad : kTurns_rad) {
    if (angle_rad > most_rad || deadline_.passed()) break;
    for (const double share : kSharesOfTurns) {
      const Quat unturned = pose_at_share(interpolated_, share).orientation;
      // About each axis, either way.
      for (int i = 0; i < 6; ++i) {
        const Vec3 axis_C = i % 2 == 0 ? Vec3::Unit(i / 2) : Vec3(-Vec3::Unit(i / 2));
        const Quat turn_C(Eigen::AngleAxisd(angle_rad, axis_C));
        std::optional<Guide> found = straight(place, unturned * turn_C);
        if (found) return found;
      }
    }
  }
  return std::nullopt;
}

std::optional<Guide> LeastTurn::grown(const LinePlace& place) {
  Fitter fitter(space_, deadline_);
  std::optional<Guide> best;
  for (const double share : kSharesOfGrowth) {
    const Quat orientation = pose_at_share(interpolated_, share).orientation;
    double most = 0.0;
    Pose largest;
    for (const Vec3& shift_W : place.shifts_W) {
      const Pose pose = space_.pose_around(place.line.center_W() + shift_W, orientation);
      const double worth =
          fitter.free_scale(pose) - kBesideLine * shift_W.norm() / space_.ball_radius_m();
      if (worth <= most) continue;
      most = worth;
      largest = pose;
    }
    const std::optional<Centered> fitted =
        most > 0.0 ? fitter.fitted(largest) : std::optional<Centered>();
    std::optional<Guide> found = fitted ? straight_from(place, fitted->pose) : std::nullopt;
    if (found && (!best || turn_rad(*found) < turn_rad(*best))) best = std::move(found);
  }
  return best;
}

std::optional<Guide> LeastTurn::straight(const LinePlace& place, const Quat& orientation) {
  for (const Vec3& shift_W : place.shifts_W) {
    const Pose pose = space_.pose_around(place.line.center_W() + shift_W, orientation);
    if (!space_.is_free(pose, margin_m_)) continue;
    if (std::optional<Guide> found = straight_from(place, pose)) return found;
  }
  return std::nullopt;
}

std::optional<Guide> LeastTurn::straight_from(const LinePlace& place, const Pose& pose) {
  std::optional<Guide> found =
      straight_passage(space_, signed_as_ends(pose, from_, to_).pose, place.line.direction_W(),
                       place.farthest_m, margin_m_);
  return found && leads_through(*found, place.way_W, space_) ? std::move(found) : std::nullopt;
}

Quat LeastTurn::nearest(const Quat& orientation) const {
  return std::ranges::min_element(
             interpolated_, {},
             [&](const Pose& pose) { return pose.orientation.angularDistance(orientation); })
      ->orientation;
}

double LeastTurn::turn_rad(const Guide& guide) const {
  const Quat orientation = geometry::from_wxyz(guide.front().orientation);
  return nearest(orientation).angularDistance(orientation);
}

}  // namespace camway::correction
