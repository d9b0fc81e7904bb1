// SPDX-License-Identifier: MIT
#include <camway/path.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace camway {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

constexpr Pose kNoPose{{kNaN, kNaN, kNaN}, {kNaN, kNaN, kNaN, kNaN}};

/// Returns the Bézier curve of `points` at `u`, by repeated linear interpolation (de Casteljau).
template <std::size_t Count, std::size_t Dimension>
std::array<double, Dimension> de_casteljau(std::array<std::array<double, Dimension>, Count> points,
                                           double u) {
  for (std::size_t left = Count - 1; left > 0; --left) {
    for (std::size_t i = 0; i < left; ++i) {
      for (std::size_t d = 0; d < Dimension; ++d) {
        points[i][d] = (1.0 - u) * points[i][d] + u * points[i + 1][d];
      }
    }
  }
  return points[0];
}

/// Returns `v` divided by its length; NaN if the length is zero or not finite.
std::array<double, 4> unit(const std::array<double, 4>& v) {
  // hypot avoids overflow and underflow, so control points may have any scale.
  const double length = std::hypot(std::hypot(v[0], v[1]), std::hypot(v[2], v[3]));
  if (!(length > 0.0) || !std::isfinite(length)) return kNoPose.orientation_wxyz;
  return {v[0] / length, v[1] / length, v[2] / length, v[3] / length};
}

}  // namespace

Path::Path(std::vector<Segment> segments) : segments_(std::move(segments)) {}

double Path::begin() const { return segments_.empty() ? 0.0 : segments_.front().t0_s; }

double Path::end() const { return segments_.empty() ? 0.0 : segments_.back().t1_s; }

Pose Path::pose(double time_s) const {
  if (segments_.empty() || std::isnan(time_s)) return kNoPose;
  const auto later =
      std::upper_bound(segments_.begin(), segments_.end(), time_s,
                       [](double time, const Segment& candidate) { return time < candidate.t0_s; });
  const Segment& segment = later == segments_.begin() ? *later : *(later - 1);
  const double u = std::clamp((time_s - segment.t0_s) / (segment.t1_s - segment.t0_s), 0.0, 1.0);
  return {de_casteljau(segment.position_m, u), unit(de_casteljau(segment.orientation_wxyz, u))};
}

}  // namespace camway
