// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/motion/path/path.h"
#include "daemon/planning/request.h"

/// What has to be asked of a path that somebody else made, beside whether its segments collide.
/// Pure functions; safe from any thread.
namespace camway::planning {

/// Why `segments` cannot be checked, as a sentence that names the segment and the field, or nothing
/// if they can. What passes can be evaluated in doubles without overflow or underflow:
/// - there is a segment; times are within `kMaxTime_s` and increase in every segment, and each
///   segment begins exactly when the one before ends, so that none is skipped;
/// - coordinates of positions are within `kMaxCoordinate_m`;
/// - coefficients of orientations are within `kLargestQuaternionCoefficient`, and at both ends of
///   each segment, where a control point is the orientation, it is long enough to be divided by its
///   length: `kLeastQuaternionLength`, and not so short beside the longest that rounding hides it.
///
/// An orientation that vanishes inside of a segment passes: the search for collisions has to count
/// as colliding what it cannot evaluate.
std::optional<std::string> find_fault(std::span<const motion::Segment> segments);

/// Squares of what is below stay finite, and so do the products of the degree-15 corner curves
/// with `kMaxCoordinate_m`. At the other end, the shortest values of the curve that rounding does
/// not hide are 5e-14 of the longest control point (`motion::corner_rounding_m`); their squares are
/// normal numbers still: (5e-14 * kLeastQuaternionLength)^2 is above 1e-227.
inline constexpr double kLargestQuaternionCoefficient = 1.0 / kLeastQuaternionLength;

/// No point of a body within `body_radius_m` of the eye is further apart at the two poses than
/// this: the way of the eye, and 2·ρ·sin(θ/2) for a turn by θ. Orientations have unit length. Plain
/// doubles, not a bound of their rounding.
double pose_distance_m(const motion::Pose& a, const motion::Pose& b, double body_radius_m);

/// The first join at which the body would jump, as a sentence, or nothing: a path from elsewhere
/// may be free on every segment and still leap through a wall between two. Two segments meet if the
/// body is no further apart at their ends than `kJoinAgreement` and the rounding of our evaluation
/// explain. Precondition: `find_fault(path.segments())` finds nothing.
std::optional<std::string> find_jump(const motion::Path& path, double body_radius_m);

/// As a share of how far a point of the body can be from the origin (distance of the eye plus
/// radius): poses that agree to nine significant digits, a hundredth of a micrometre ten metres
/// from the origin. A double rounds by 1.1e-16, so two ends that are computed apart, by up to 10^6
/// operations each, are within it, and so are ends written with ten digits. In single precision the
/// two ends have to be the same numbers, as a common control point is.
inline constexpr double kJoinAgreement = 1e-9;

/// What closes the gap that `find_jump` allows.
struct Bridge {
  double time_s;      ///< of the join
  motion::Path path;  ///< of one segment; its times mean nothing
};

/// A continuous motion over each join of `path` whose ends are not the same pose, straight from the
/// one to the other, and exactly from and to the poses that the control points define. If the path
/// and its bridges are free, no wall stands in a gap, however thin. Joins whose control points are
/// the same, up to a power of two and a sign in the orientation, which change no pose, need no
/// bridge. Precondition: `find_jump` finds nothing.
std::vector<Bridge> bridges(const motion::Path& path);

/// By how much the path misses each of `keyframes`, in their order: `pose_distance_m` of the path
/// at the keyframe's time from the keyframe. The path stands still before its beginning and after
/// its end. Precondition: `path` not empty.
std::vector<double> keyframe_misses_m(const motion::Path& path,
                                      std::span<const motion::Keyframe> keyframes,
                                      double body_radius_m);

}  // namespace camway::planning
