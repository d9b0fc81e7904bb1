// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/collision/interval.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/motion/path/stretch.h"
#include "daemon/motion/spline/cubic_path.h"

namespace camway::correction {

/// What a corrected path may lose on the interpolated one where a rule measures by that: the
/// horizon's tilt under kLevel, and the angle off a target that was outside the cone under kTarget.
/// For a spline of orientations through level knots is not quite level between them (that of
/// interpolation neither: up to 1.1°), and a bump begins with no room at all. 0.57°.
inline constexpr double kOrientationAllowance_rad = 0.01;

/// By how much a pose meets the rule and the limit of turning, as radians or sines; negative: it
/// breaks one. `interpolated` is the pose of the interpolated path at the same time. Infinite
/// where nothing can break the rule. That nothing turns, under kKeep and a limit of 0, is not a
/// matter of room: that is for who makes the path (`may_turn_in`), and counts as no rule here.
///
/// kLevel allows turns about `up_W` and about the axis across the view, and takes tilt away, but:
/// the axis across the view is nowhere further out of the horizontal plane than on the
/// interpolated path at that time, and the camera not turned over, unless it was there (each up to
/// `kOrientationAllowance_rad`). Looking straight up or down, where the image has no horizon, it
/// may turn about the view; beyond that it would be upside down.
double rule_room(const OrientationPolicy& policy, const motion::Pose& now,
                 const motion::Pose& interpolated);

/// A lower bound of that over two stretches of the same time, rounding apart: from the middle poses
/// and the bounds of the motion, so nothing is sampled.
double least_rule_room(const OrientationPolicy& policy, const motion::Stretch& now,
                       const motion::Stretch& interpolated);

/// `wanted`, turned about the body's point `pivot_C` as little as the rule asks for, about; as it
/// is, bit for bit, where it is allowed. Not exact where two rules meet: see `rule_room`.
/// kLevel: rolled about its view. kTarget: turned towards the target. The limit of turning: part
/// of the way from `interpolated`.
motion::Pose allowed_pose(const OrientationPolicy& policy, const motion::Pose& wanted,
                          const motion::Pose& interpolated, const geometry::Vec3& pivot_C);

/// Where `now` first breaks the rule between the two times, or cannot be shown to meet it, about.
/// Nothing: it meets it at every time in between, proved by the bounds of both paths' motion,
/// rounding apart. Precondition: both cover that time.
std::optional<collision::CollisionInterval> first_breach(const OrientationPolicy& policy,
                                                         const motion::CubicPath& now,
                                                         const motion::CubicPath& interpolated,
                                                         double t_begin_s, double t_end_s);

/// Of the limit of turning and of the cone: as much of it is used by what is wanted, so that the
/// spline between knots keeps within it.
inline constexpr double kAimedShare = 0.95;

}  // namespace camway::correction
