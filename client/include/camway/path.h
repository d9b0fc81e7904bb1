// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

namespace camway {

/// Where a camera is and how it is turned.
struct Pose {
  std::array<double, 3> position_m{};  ///< the eye, in the world frame
  std::array<double, 4> orientation_wxyz{1, 0, 0,
                                         0};  ///< unit Hamilton quaternion, camera to world
};

/// One piece of a path, exactly as it came. With `u = (t - t0_s) / (t1_s - t0_s)` the position is
/// the cubic Bézier curve of `position_m`, and the orientation is the degree-6 Bézier curve of
/// `orientation_wxyz` divided by its length.
struct Segment {
  double t0_s = 0.0;
  double t1_s = 0.0;
  std::array<std::array<double, 3>, 4> position_m{};
  std::array<std::array<double, 4>, 7> orientation_wxyz{};
};

/// A path in time: segments that follow each other without a gap. These numbers are the path, not
/// an approximation of it: what the daemon checked against the scene is what `pose` evaluates. A
/// value; safe to read from any number of threads.
class Path {
 public:
  Path() = default;
  /// Precondition: the segments are in order, each ends where the next begins, `t0_s < t1_s`.
  explicit Path(std::vector<Segment> segments);

  bool empty() const { return segments_.empty(); }
  const std::vector<Segment>& segments() const { return segments_; }

  /// First and last instant [Units: seconds]; 0 for an empty path.
  double begin() const;
  double end() const;

  /// The pose at `time_s`, by de Casteljau. Times outside the path give its first or last pose.
  /// Where segments meet, the later one is used. Has no pose to give for an empty path, a time that
  /// is not a number, or a segment whose orientation vanishes: the numbers are NaN then.
  Pose pose(double time_s) const;

 private:
  std::vector<Segment> segments_;
};

}  // namespace camway
