// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

namespace camway {

/// Position and orientation of a camera or an object.
struct Pose {
  std::array<double, 3> position_m{};  ///< the eye, or the object's origin, in the world frame
  /// Unit Hamilton quaternion; rotates vectors of the camera, or of the object, into the world.
  std::array<double, 4> orientation_wxyz{1, 0, 0, 0};
};

/// One segment of a path, with the numbers that the daemon sent. With
/// `u = (t - t0_s) / (t1_s - t0_s)`, the position is the cubic Bézier curve of `position_m`, and
/// the orientation is the degree-6 Bézier curve of `orientation_wxyz` divided by its length.
struct Segment {
  double t0_s = 0.0;
  double t1_s = 0.0;
  std::array<std::array<double, 3>, 4> position_m{};
  std::array<std::array<double, 4>, 7> orientation_wxyz{};
};

/// A motion over time: consecutive segments, each beginning where the one before ends. The daemon
/// checked these numbers themselves against the scene; they do not approximate another path.
///
/// A value type. Concurrent reads are safe.
class Path {
 public:
  Path() = default;
  /// Requires segments in order of time, each ending where the next begins, with `t0_s < t1_s`.
  explicit Path(std::vector<Segment> segments);

  bool empty() const { return segments_.empty(); }
  const std::vector<Segment>& segments() const { return segments_; }

  /// Returns the first and the last instant; 0 for an empty path. [Units: seconds]
  double begin() const;
  double end() const;

  /// Returns the pose at `time_s`, evaluated by de Casteljau's algorithm. A time outside the path
  /// returns its first or last pose; where two segments meet, the later one is evaluated. Returns
  /// NaN in every member if the path is empty or the time is NaN, and a NaN orientation where the
  /// orientation curve vanishes.
  Pose pose(double time_s) const;

 private:
  std::vector<Segment> segments_;
};

}  // namespace camway
