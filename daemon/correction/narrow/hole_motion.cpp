// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/hole_motion.h"

#include <algorithm>

namespace camway::correction {

namespace {

using geometry::Vec3;
using motion::SignedPose;

// Chosen by measurement; none changes what is proved.
constexpr double kNearest = 1.05;    // least motion that leaves a thin wall, in radii of the ball
constexpr double kShareOfHit = 0.9;  // of the motion up to where it is blocked

SignedPose moved(const SignedPose& pose, const Vec3& by_W) {
  return {pose.position + by_W, pose.orientation};
}

}  // namespace

std::array<Vec3, 4> shifts_of(const Side& side, const Side& other) {
  return {Vec3::Zero(), side.to_middle_W, other.to_middle_W, side.to_middle_W + other.to_middle_W};
}

SignedLikeEnds signed_as_ends(const motion::Pose& pose, const SignedPose& from,
                              const SignedPose& to) {
  SignedPose result = motion::signed_pose(pose);
  const double to_from = result.orientation.dot(from.orientation);
  const double to_to = result.orientation.dot(to.orientation);
  if (to_from + to_to >= 0.0) return {std::min(to_from, to_to), result};
  result.orientation *= -1.0;
  return {std::min(-to_from, -to_to), result};
}

std::optional<Guide> straight_passage(FreeSpace& space, const SignedPose& pose, const Vec3& along_W,
                                      double farthest_m, double margin_m) {
  const auto end = [&](const Vec3& direction_W) -> std::optional<SignedPose> {
    const std::optional<double> hit =
        space.first_hit(pose, moved(pose, farthest_m * direction_W), margin_m);
    const double length_m = farthest_m * (hit ? kShareOfHit * *hit : 1.0);
    if (length_m < kNearest * space.ball_radius_m()) return std::nullopt;
    return moved(pose, length_m * direction_W);
  };
  const std::optional<SignedPose> back = end(-along_W);
  const std::optional<SignedPose> forth = back ? end(along_W) : std::nullopt;
  if (!forth) return std::nullopt;
  return Guide{*back, *forth};
}

bool leads_through(const Guide& poses, std::span<const Vec3> way_W, const FreeSpace& space) {
  const auto ahead_m = [&](const SignedPose& pose) {
    const Vec3 center_W = space.center_W(motion::unsigned_pose(pose));
    return (center_W - way_W.front()).norm() - (center_W - way_W.back()).norm();
  };
  return ahead_m(poses.front()) < 0.0 && ahead_m(poses.back()) > 0.0;
}

}  // namespace camway::correction
