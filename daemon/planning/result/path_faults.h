// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/motion/path/path.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/request/validate.h"

/// Checks of a path that was made elsewhere, besides the search for collisions.
/// Thread-safe.
namespace camway::planning {

/// Returns why `segments` cannot be checked, as a sentence that names the segment and the field;
/// nothing if they can. Segments without a fault can be evaluated in doubles without overflow or
/// underflow:
/// - there is a segment; times are within `kMaxTime_s` and increase in every segment; each segment
///   begins exactly when the one before ends, so that no time is skipped;
/// - coordinates of positions are within `kMaxCoordinate_m`;
/// - coefficients of orientations are within `kLargestQuaternionCoefficient`; the control points at
///   both ends, which are orientations, have a length of at least `kLeastQuaternionLength`, and one
///   that rounding does not hide beside the longest control point.
///
/// An orientation may vanish inside a segment: the search for collisions counts a stretch that it
/// cannot evaluate as colliding.
std::optional<std::string> find_fault(std::span<const motion::Segment> segments);

/// Squares of smaller coefficients stay finite, and so do the products of the degree-15 corner
/// curves with `kMaxCoordinate_m`. At the other end, the shortest values of the orientation curve
/// that rounding does not hide are 5e-14 of the longest control point
/// (`motion::corner_rounding_m`); their squares are still normal numbers: (5e-14 *
/// kLeastQuaternionLength)^2 is above 1e-227.
inline constexpr double kLargestQuaternionCoefficient = 1.0 / kLeastQuaternionLength;

/// Returns a bound of how far apart a point of the body can be at the two poses, for a body within
/// `body_radius_m` of the eye: the distance of the eyes plus 2·ρ·sin(θ/2) for a turn by θ. Requires
/// orientations of unit length. Computed in plain doubles; the rounding is not bounded.
double pose_distance_m(const motion::Pose& a, const motion::Pose& b, double body_radius_m);

/// Returns the first join at which the body would jump, as a sentence; nothing if there is none. A
/// path from elsewhere may be free on every segment and still leap through a wall between two. Two
/// segments meet if the body is no further apart at their ends than `kJoinAgreement` and the
/// rounding of our evaluation explain. Requires that `find_fault(path.segments())` finds nothing.
std::optional<std::string> find_jump(const motion::Path& path, double body_radius_m);

/// Largest distance of two ends that meet, as a share of how far a point of the body can be from
/// the origin (distance of the eye plus radius): nine significant digits, a hundredth of a
/// micrometre ten metres from the origin. A double rounds by 1.1e-16, so two ends that are computed
/// separately, by up to 10^6 operations each, are within it, and so are ends written with ten
/// digits. In single precision the two ends have to be the same numbers, as a common control point
/// is.
inline constexpr double kJoinAgreement = 1e-9;

/// A motion over a join whose ends differ by what `find_jump` allows.
struct Bridge {
  double time_s;      ///< time of the join
  motion::Path path;  ///< one segment, whose times mean nothing
};

/// Returns a straight, continuous motion over each join of `path` whose ends are not the same pose,
/// exactly from and to the poses that the control points define. If the path and its bridges are
/// free, no wall stands between two segments, however thin. A join needs no bridge if its control
/// points are the same up to a power of two and a sign in the orientation, which change no pose.
/// Requires that `find_jump` finds nothing.
std::vector<Bridge> bridges(const motion::Path& path);

/// Returns by how much the path misses each of `keyframes`, in their order: `pose_distance_m`
/// between the keyframe and the path at the keyframe's time. Before its beginning and after its end
/// the path stands still. Requires a path that is not empty.
std::vector<double> keyframe_misses_m(const motion::Path& path,
                                      std::span<const motion::Keyframe> keyframes,
                                      double body_radius_m);

}  // namespace camway::planning
