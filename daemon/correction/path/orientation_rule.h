// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/collision/interval.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/motion/path/stretch.h"
#include "daemon/motion/spline/cubic_path.h"

namespace camway::correction {

/// Tolerance, 0.57°, of conditions that compare with the interpolated path: the tilt of the horizon
/// under kLevel, and the angle off a target that was outside of the cone under kTarget. It is
/// needed because a spline through level knots is not exactly level between them (the interpolated
/// path tilts by up to 1.1°), and because a bump starts with no margin at all.
inline constexpr double kOrientationAllowance_rad = 0.01;

/// Share of the cone and of the limit of turning that `allowed_pose` uses; the rest is for the
/// spline between knots.
inline constexpr double kAimedShare = 0.95;

/// Margin by which the pose `now` meets the rule and the limit of turning, in radians or as a sine;
/// negative if it violates one, infinite if it cannot. `interpolated` is the pose of the
/// interpolated path at the same time. Ignores kKeep and a limit of 0: path builders enforce these
/// (`may_turn_in`).
///
/// kLevel allows turns about `up_W` and about the camera's x axis, and turns that reduce tilt. At
/// every time it requires that
/// - the x axis is no farther out of the horizontal plane than on the interpolated path, and
/// - the camera is not upside down, unless it was there,
///
/// each up to `kOrientationAllowance_rad`. A camera that looks straight up or down, where the image
/// has no horizon, may turn about its view axis.
double rule_room(const OrientationPolicy& policy, const motion::Pose& now,
                 const motion::Pose& interpolated);

/// Lower bound of `rule_room` over two stretches of the same time range, rounding apart. It follows
/// from the middle poses and the motion bounds; nothing is sampled.
double least_rule_room(const OrientationPolicy& policy, const motion::Stretch& now,
                       const motion::Stretch& interpolated);

/// Turns `wanted` about the body's point `pivot_C` by about the least angle that meets the policy;
/// returns `wanted` bit for bit if it meets the policy already. Under kLevel it rolls about the
/// view axis, under kTarget it turns towards the target, and for the limit of turning it goes part
/// of the way from `interpolated`. Approximate where the rule and the limit both apply: check with
/// `rule_room`.
motion::Pose allowed_pose(const OrientationPolicy& policy, const motion::Pose& wanted,
                          const motion::Pose& interpolated, const geometry::Vec3& pivot_C);

/// Returns about the first time range in which `now` violates the policy or cannot be shown to meet
/// it. Returns nothing if it meets the policy at every time in [t_begin_s, t_end_s], proved by the
/// motion bounds of both paths, rounding apart. Requires both paths to cover that range.
std::optional<collision::CollisionInterval> first_breach(const OrientationPolicy& policy,
                                                         const motion::CubicPath& now,
                                                         const motion::CubicPath& interpolated,
                                                         double t_begin_s, double t_end_s);

}  // namespace camway::correction
