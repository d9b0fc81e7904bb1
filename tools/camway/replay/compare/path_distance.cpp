// SPDX-License-Identifier: MIT
#include "tools/camway/replay/compare/path_distance.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace camway::tools {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Samples between two joins, where a path is a smooth curve of low degree.
constexpr int kSamplesPerPiece = 32;

PathDistance pose_distance(const Yardstick& yardstick, const motion::Pose& a,
                           const motion::Pose& b) {
  const geometry::Vec3 moved = b.position - a.position;
  const Eigen::Matrix3d turned =
      b.orientation.toRotationMatrix() - a.orientation.toRotationMatrix();
  const double turn_rad = a.orientation.angularDistance(b.orientation);
  PathDistance distance{moved.norm(), turn_rad + moved.norm() / yardstick.viewing_distance_m};
  for (const geometry::Triangle& triangle : yardstick.body.triangles_C()) {
    for (const geometry::Vec3& corner_C : triangle) {
      const geometry::Vec3 apart = moved + turned * corner_C;
      distance.path_m = std::max(distance.path_m, apart.norm());
    }
  }
  return distance;
}

/// Returns the larger distance. A pose with NaN must not count as no difference.
double larger(double largest, double distance) {
  return distance >= 0.0 ? std::max(largest, distance) : kInfinity;
}

}  // namespace

PathDistance path_distance(const motion::Path& a, const motion::Path& b,
                           const Yardstick& yardstick) {
  if (a.empty() || b.empty()) return {kInfinity, kInfinity};
  if (a.begin_s() != b.begin_s() || a.end_s() != b.end_s()) return {kInfinity, kInfinity};
  std::vector<double> joins{a.begin_s()};
  for (const motion::Path* path : {&a, &b}) {
    for (const motion::Segment& segment : path->segments()) joins.push_back(segment.t1_s);
  }
  std::sort(joins.begin(), joins.end());
  // Different bits can round to the same samples, but only equal bits may give 0.
  constexpr double kLeast = std::numeric_limits<double>::denorm_min();
  PathDistance largest{kLeast, kLeast};
  for (std::size_t i = 1; i < joins.size(); ++i) {
    for (int k = 0; k <= kSamplesPerPiece; ++k) {
      const double time_s = joins[i - 1] + (joins[i] - joins[i - 1]) * k / kSamplesPerPiece;
      const PathDistance here = pose_distance(yardstick, a.pose(time_s), b.pose(time_s));
      largest.path_m = larger(largest.path_m, here.path_m);
      largest.shift_rad = larger(largest.shift_rad, here.shift_rad);
    }
  }
  return largest;
}

}  // namespace camway::tools
