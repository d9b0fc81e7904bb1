// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "daemon/correction/path/free_space.h"
#include "daemon/motion/spline/bump.h"

namespace camway::correction {

/// A collision-free polyline of poses, joined by straight motions. Searches return one; a detour
/// follows it.
using Guide = std::vector<motion::SignedPose>;

/// The pose of `path` at a time, with the sign of its image in R⁴.
motion::SignedPose signed_pose_at(const motion::CubicPath& path, double time_s);

/// The pose at a share of a row of poses at equal steps, between its neighbours. [Limit: two poses
/// or more; 0 <= share <= 1]
motion::Pose pose_at_share(std::span<const motion::Pose> poses, double share);

/// Coefficients of a row of bumps between two keyframes, which lie at knots 0 and `knots.count`.
struct Offsets {
  motion::KnotRow knots;
  int first = 1;  ///< knot of the first coefficient; below 1 at or before the first keyframe
  std::vector<motion::CubicPoint> at;

  [[nodiscard]] int last() const { return first + static_cast<int>(at.size()) - 1; }
  /// The coefficient at knot `k`; zero outside of the row.
  [[nodiscard]] motion::CubicPoint operator()(int k) const {
    return k < first || k > last() ? motion::CubicPoint{} : at[static_cast<std::size_t>(k - first)];
  }
};

/// A guide with times: a body that follows it stays close to its place on the path at the same
/// time, and moves at most at twice the guide's mean speed.
class TimedGuide {
 public:
  /// Requires `path` and `guide` to meet at `begin_s` and at `end_s`. Refers to `guide`, which must
  /// outlive it.
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
  std::vector<double> shares_;    ///< fractions of the guide travelled at equidistant times
};

/// Orientation of a path that follows a guide.
enum class Turning {
  kAsGuide,  ///< the guide's orientation
  kAsPath,   ///< the path's orientation at the same time; the body's centre follows the guide
};

/// Offsets from `path` to the guide at the inner knots, with orientations turned until they meet
/// the policy relative to `interpolated`. Returns nothing if the guide arrives with the opposite
/// sign of the image, so that its orientations cannot be lifted to R⁴.
std::optional<Offsets> offsets_to(const motion::CubicPath& path,
                                  const motion::CubicPath& interpolated, const TimedGuide& guide,
                                  const motion::KnotRow& knots, Turning turning,
                                  const FreeSpace& space);

/// Effect of a row of bumps on the two keyframes at its ends.
enum class Ends {
  kFree,  ///< the keyframes are kept, but the path's slope there may change, and so the path beyond
  kFixed,  ///< nothing changes at the keyframes or beyond
};

/// The row of bumps with `offsets` as coefficients. This is Schoenberg's operator, which oscillates
/// no more than the offsets do (Schoenberg 1967, "On spline functions", variation diminishing). The
/// coefficients at the keyframes are set so that the row vanishes there.
motion::BumpRow bumps_for(const Offsets& offsets, Ends ends);

/// The coefficient at `knot` that makes the row zero there, given its neighbours' coefficients.
motion::CubicPoint holding(const motion::KnotRow& knots, int knot, const motion::CubicPoint& before,
                           const motion::CubicPoint& after);

/// Largest number of parts of a motion. Chosen by measurement.
inline constexpr int kMostPartsOfMotion = 64;

/// Divides the motions of `guide`, each into the fewest equal parts that are at most `longest_m`
/// long, but no more than `kMostPartsOfMotion`. [Limit: 0 < longest_m]
Guide divided(const Guide& guide, const FreeSpace& space, double longest_m);

/// Removes poses of `guide` that a free straight motion can skip.
Guide shortened(const Guide& guide, FreeSpace& space, double margin_m);

}  // namespace camway::correction
