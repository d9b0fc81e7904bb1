// SPDX-License-Identifier: MIT
#include "daemon/paper/swept_surface.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "daemon/motion/path/bezier.h"
#include "daemon/paper/corner_curve.h"

namespace camway::paper {
namespace {

using geometry::Vec3;
using motion::Corners;
using motion::Path;
using motion::Segment;
namespace bezier = motion::bezier;

/// Largest growth of the error from one attempt to the next. The number of strips that a path needs
/// grows with the inverse root of the error, so growing the error by the inverse of the fraction
/// that was done does not overshoot. But an attempt that ran out of strips at the very beginning,
/// on one extreme segment, says little about the rest.
constexpr double kMostCoarsening = 1e6;

/// The near quadrilateral where one strip ends and the next begins.
struct Station {
  double time_s;
  Corners corners_W;
};

/// Bounds the distance between the corner curve and its chord at equal parameters. With numerator N
/// and denominator W > 0 in Bernstein form, c - L = (N - L·W)/W: the hull of the numerator's
/// coefficients over the least coefficient of W. Infinite if W is not proved positive.
double chord_error_bound_m(const RationalCurve& curve) {
  std::array<Vec3, 16> numerator;
  std::array<double, 16> weights;
  for (std::size_t i = 0; i < 16; ++i) {
    numerator[i] = curve.homogeneous[i].head<3>();
    weights[i] = curve.homogeneous[i][3];
  }
  const double least_weight = std::ranges::min(weights);
  if (!(least_weight > 0.0)) return std::numeric_limits<double>::infinity();
  const std::array<Vec3, 2> chord = {Vec3(numerator[0] / weights[0]),
                                     Vec3(numerator[15] / weights[15])};
  const std::array<Vec3, 17> on_chord = bezier::product(
      chord, weights, [](const Vec3& point, double weight) { return Vec3(point * weight); });
  const std::array<Vec3, 17> on_curve = bezier::elevated<1>(numerator);
  double largest = 0.0;
  for (std::size_t i = 0; i < 17; ++i)
    largest = std::max(largest, (on_curve[i] - on_chord[i]).norm());
  return largest / least_weight;
}

/// Bounds the distance of the four ruled surfaces over `part` from the triangles between its ends.
double strip_error_bound_m(const Segment& part, const Corners& corners_C, const Station& from,
                           const Station& to) {
  std::array<double, 4> chord_error_m;
  // Relative to the middle of the strip, so that rounding scales with its size and not with its
  // distance from the origin.
  Segment centred = part;
  const Vec3 centre = 0.5 * (part.position[0] + part.position[3]);
  for (Vec3& point : centred.position) point -= centre;
  for (std::size_t i = 0; i < 4; ++i)
    chord_error_m[i] = chord_error_bound_m(corner_curve(centred, corners_C[i]));
  double error_m = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    // A bilinear patch leaves the two triangles on its diagonal by v(1 - u)·|twist| at most.
    const Vec3 twist =
        (to.corners_W[j] - to.corners_W[i]) - (from.corners_W[j] - from.corners_W[i]);
    error_m = std::max(error_m, std::max(chord_error_m[i], chord_error_m[j]) + twist.norm() / 4.0);
  }
  return error_m;
}

/// One attempt to sample the surface within one error, in order of time.
class Sampler {
 public:
  Sampler(const Path& path, const Corners& corners_C, double error_m, double begin_s, double end_s)
      : path_(path), corners_C_(corners_C), error_m_(error_m), begin_s_(begin_s), end_s_(end_s) {}

  /// False if too many strips would be needed.
  bool run() {
    for (std::size_t i = path_.segment_index(begin_s_); i < path_.segments().size(); ++i) {
      const Segment& segment = path_.segments()[i];
      if (segment.t0_s >= end_s_) break;
      const double u0 = motion::segment_parameter(segment, begin_s_);
      const double u1 = motion::segment_parameter(segment, end_s_);
      if (!(u0 < u1)) continue;  // less than rounding of it
      const Station from = station(segment, u0);
      if (stations_.empty()) stations_.push_back(from);
      if (!sample(segment, u0, u1, from, station(segment, u1), 0)) return false;
    }
    if (stations_.empty()) return true;
    stations_.front().time_s = begin_s_;
    stations_.back().time_s = end_s_;
    return true;
  }

  [[nodiscard]] const std::vector<Station>& stations() const { return stations_; }

  /// The share of the time span that is done.
  [[nodiscard]] double fraction_done() const {
    if (stations_.empty()) return 0.0;
    return (stations_.back().time_s - begin_s_) / (end_s_ - begin_s_);
  }

 private:
  [[nodiscard]] Station station(const Segment& segment, double u) const {
    return {std::clamp(motion::segment_time_s(segment, u), begin_s_, end_s_),
            motion::corners_W(corners_C_, motion::pose_at(segment, u))};
  }

  bool sample(const Segment& segment, double u0, double u1, const Station& from, const Station& to,
              int depth) {
    if (stations_.size() > kMaxSweptStrips + path_.segments().size()) return false;
    const Segment part = motion::sub_segment(segment, u0, u1);
    const double middle = u0 + (u1 - u0) / 2.0;
    if (depth >= kMaxSweptDepth || strip_error_bound_m(part, corners_C_, from, to) <= error_m_) {
      stations_.push_back(to);
      return true;
    }
    const Station at_middle = station(segment, middle);
    return sample(segment, u0, middle, from, at_middle, depth + 1) &&
           sample(segment, middle, u1, at_middle, to, depth + 1);
  }

  const Path& path_;
  const Corners& corners_C_;
  double error_m_;
  double begin_s_;
  double end_s_;
  std::vector<Station> stations_;
};

double size_m(const Path& path, const Corners& corners_C) {
  double size_m = motion::body_radius_m(corners_C);
  for (const Segment& segment : path.segments()) {
    for (const Vec3& point : segment.position)
      size_m = std::max(size_m, point.norm() + motion::body_radius_m(corners_C));
  }
  return size_m;
}

void add_strip(const Station& from, const Station& to, std::vector<SweptTriangle>& triangles) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    const SweptVertex from_i{from.corners_W[i], from.time_s};
    const SweptVertex from_j{from.corners_W[j], from.time_s};
    const SweptVertex to_i{to.corners_W[i], to.time_s};
    const SweptVertex to_j{to.corners_W[j], to.time_s};
    triangles.push_back({{from_i, to_i, to_j}, static_cast<int>(i)});
    triangles.push_back({{from_i, to_j, from_j}, static_cast<int>(i)});
  }
}

}  // namespace

double SweptTriangle::first_time_s() const {
  return std::min({vertices[0].time_s, vertices[1].time_s, vertices[2].time_s});
}

double SweptTriangle::last_time_s() const {
  return std::max({vertices[0].time_s, vertices[1].time_s, vertices[2].time_s});
}

std::vector<SweptTriangle> tessellate_swept_surface(const Path& path, const Corners& corners_C,
                                                    double chord_error_m, double t_begin_s,
                                                    double t_end_s) {
  assert(chord_error_m > 0.0);
  const double begin_s = std::max(t_begin_s, path.begin_s());
  const double end_s = std::min(t_end_s, path.end_s());
  if (!(begin_s < end_s)) return {};
  const double rounding_m = kSweptRounding * size_m(path, corners_C);
  for (double error_m = std::max(chord_error_m - rounding_m, rounding_m);;) {
    Sampler sampler(path, corners_C, error_m, begin_s, end_s);
    if (sampler.run()) {
      std::vector<SweptTriangle> triangles;
      const std::vector<Station>& stations = sampler.stations();
      for (std::size_t i = 1; i < stations.size(); ++i)
        add_strip(stations[i - 1], stations[i], triangles);
      return triangles;
    }
    error_m *= std::clamp(1.0 / sampler.fraction_done(), 2.0, kMostCoarsening);
  }
}

}  // namespace camway::paper
