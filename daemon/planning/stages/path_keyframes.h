// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/spline/cubic_path.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"
#include "daemon/planning/stages/prepare.h"

/// The keyframes of an answer. If nothing was corrected or slowed, they are those of the
/// request, and so is the frame, if there is one. A corrected path has a keyframe at every knot of
/// its spline, and a frame: the same request with these keyframes and this frame has the same path,
/// which collides nowhere else. The paper's method interpolates its inserted keyframes as a request
/// does, so they need no frame. A slowed path has no frame, and its keyframes do not give it: its
/// times follow a law, not a spline of the keyframes.
namespace camway::planning {

/// Sets the keyframes and the frame of `result` to those of `path`, which was corrected. Returns
/// false, and changes nothing, if a request may not hold them, or if their path differs from `path`
/// by more than `kMostReplanned_m` or `kMostReplanned_rad`.
bool set_keyframes(const motion::CubicPath& path, const PlanRequest& request,
                   const PreparedPlan& prepared, PlanResult& result);

/// Sets the keyframes and the frame of `result` to those of the path as interpolated.
void reset_keyframes(const PreparedPlan& prepared, PlanResult& result);

/// Removes the frame from `result`, for a path that keyframes and a frame do not give.
void drop_frame(PlanResult& result);

/// Largest differences of the two paths, in position and in orientation, at any instant. The
/// rounding of coordinates adds `kReplanRoundings` epsilons of the largest coordinate to
/// `kMostReplanned_m`. Short steps beside long ones amplify it: to 1,051 epsilons at most in 306
/// requests in scenes of 20 to 100 km, whose viewing distance of at most 10 m makes corrections
/// short. Four times as many are allowed.
inline constexpr double kMostReplanned_m = 5e-10;
inline constexpr double kMostReplanned_rad = 5e-10;
inline constexpr double kReplanRoundings = 4096.0;

}  // namespace camway::planning
