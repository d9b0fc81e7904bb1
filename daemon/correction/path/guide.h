// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "daemon/correction/path/free_space.h"
#include "daemon/motion/spline/bump.h"

namespace camway::correction {

/// A way that is free of collision but not smooth: straight motions from pose to pose. What
/// searches find, and what a correction is then drawn towards.
using Guide = std::vector<motion::SignedPose>;

/// The way that `path` itself takes at a time, with the sign that its image has there.
motion::SignedPose signed_pose_at(const motion::CubicPath& path, double time_s);

/// Coefficients of a row of bumps that replaces a path between two keyframes, which stand at the
/// first and the last of the row's own knots.
struct Offsets {
  motion::KnotRow knots;
  int first = 1;  ///< knot of the first coefficient; below 1 it is before the first keyframe
  std::vector<motion::CubicPoint> at;

  [[nodiscard]] int last() const { return first + static_cast<int>(at.size()) - 1; }
  /// The coefficient at knot `k`; zero outside the row.
  [[nodiscard]] motion::CubicPoint operator()(int k) const {
    return k < first || k > last() ? motion::CubicPoint{} : at[static_cast<std::size_t>(k - first)];
  }
};

/// A guide, and when it is where: so that the body stays close to where the path has it at the same
/// time, and does not hurry.
class TimedGuide {
 public:
  /// From `begin_s` to `end_s`, where `path` and `guide` meet.
  TimedGuide(const motion::CubicPath& path, const Guide& guide, double begin_s, double end_s,
             const FreeSpace& space);

  [[nodiscard]] motion::SignedPose at(double time_s) const;

 private:
  [[nodiscard]] motion::SignedPose after(double share) const;
  void choose_shares(const motion::CubicPath& path);

  const Guide& guide_;
  const double begin_s_;
  const double end_s_;
  std::vector<double> so_far_m_;  ///< distance travelled at each pose of the guide
  std::vector<double> shares_;    ///< of it, at equidistant times
};

/// How a path is oriented that is drawn towards a guide.
enum class Turning {
  kAsGuide,
  kAsPath,  ///< as it was at the same time; the middle of the body is where the guide has it
};

/// What has to be added to `path` at the inner knots to be where the guide is, turned as far as the
/// rule for orientations allows, by comparison with `interpolated`. Nothing where the guide's
/// orientation cannot be lifted to the path's image: it would arrive with the other sign.
std::optional<Offsets> offsets_to(const motion::CubicPath& path,
                                  const motion::CubicPath& interpolated, const TimedGuide& guide,
                                  const motion::KnotRow& knots, Turning turning,
                                  const FreeSpace& space);

/// What a row of bumps does at the two keyframes.
enum class Ends {
  kFree,   ///< keeps them, but may change the path's slope there, and so what is beyond
  kFixed,  ///< changes nothing there, nor beyond
};

/// The offsets as a row of bumps: Schoenberg's operator, which swings no more than they do
/// (Schoenberg 1967, "On spline functions", variation diminishing). What is to be zero at the
/// keyframes is made so.
motion::BumpRow bumps_for(const Offsets& offsets, Ends ends);

/// The coefficient of the bump at a knot that makes the sum zero there.
motion::CubicPoint holding(const motion::KnotRow& knots, int knot, const motion::CubicPoint& before,
                           const motion::CubicPoint& after);

/// Leaves out poses of `guide` where the straight motion between others is free and shorter.
Guide shortened(const Guide& guide, FreeSpace& space, double margin_m);

}  // namespace camway::correction
