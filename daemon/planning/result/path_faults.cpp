// SPDX-License-Identifier: MIT
#include "daemon/planning/result/path_faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "daemon/motion/body/corner_rounding.h"
#include "daemon/motion/path/straight_motion.h"
#include "daemon/planning/request/validate.h"

namespace camway::planning {

namespace {

using geometry::Vec3;
using geometry::Vec4;
using motion::Pose;
using motion::Segment;

std::optional<std::string> fault_in_times(const Segment& segment, const Segment* before) {
  for (const auto& [name, time_s] : {std::pair{"t0", segment.t0_s}, {"t1", segment.t1_s}}) {
    // Written so that NaN fails, here and below.
    if (!(std::abs(time_s) <= kMaxTime_s)) {
      return fmt::format("{}: is {}; it must be finite and within {:g} s", name, time_s,
                         kMaxTime_s);
    }
  }
  if (!(segment.t0_s < segment.t1_s)) {
    return fmt::format("t1: is {} s, not after t0, {} s", segment.t1_s, segment.t0_s);
  }
  if (before != nullptr && segment.t0_s != before->t1_s) {
    return fmt::format("t0: is {} s; the segment before ends at {} s", segment.t0_s, before->t1_s);
  }
  return std::nullopt;
}

std::optional<std::string> fault_in_position(const Segment& segment) {
  for (std::size_t i = 0; i < segment.position.size(); ++i) {
    for (const double x_m : segment.position[i]) {
      if (std::abs(x_m) <= kMaxCoordinate_m) continue;
      return fmt::format("position[{}]: holds {}; coordinates must be finite and within {:g} m", i,
                         x_m, kMaxCoordinate_m);
    }
  }
  return std::nullopt;
}

std::optional<std::string> fault_in_orientation(const Segment& segment) {
  for (std::size_t i = 0; i < segment.orientation.size(); ++i) {
    for (const double c : segment.orientation[i]) {
      if (std::abs(c) <= kLargestQuaternionCoefficient) continue;
      return fmt::format("orientation[{}]: holds {}; coefficients must be finite and within {:g}",
                         i, c, kLargestQuaternionCoefficient);
    }
  }
  for (const std::size_t end : {std::size_t{0}, segment.orientation.size() - 1}) {
    // No squares, which could underflow.
    const double length = segment.orientation[end].stableNorm();
    if (!(length >= kLeastQuaternionLength)) {
      return fmt::format("orientation[{}]: has length {:g}; an orientation needs {:g} at least",
                         end, length, kLeastQuaternionLength);
    }
    if (!std::isfinite(motion::corner_rounding_m(segment, end == 0 ? 0.0 : 1.0, 1.0))) {
      return fmt::format(
          "orientation[{}]: has length {:g}, too short beside the other control points to tell an "
          "orientation",
          end, length);
    }
  }
  return std::nullopt;
}

/// `q` times the power of two that brings its length between 1/2 and 1: the same orientation, bit
/// for bit unless it underflows beside a coefficient 10^300 times as large.
Vec4 scaled(const Vec4& q) {
  int exponent = 0;
  std::frexp(q.norm(), &exponent);
  return q.unaryExpr([exponent](double c) { return std::ldexp(c, -exponent); });
}

/// Returns the straight motion over the join; nothing if both ends are the same pose.
std::optional<Segment> bridge(const Segment& before, const Segment& after) {
  const Vec3& p0 = before.position.back();
  const Vec3& p1 = after.position.front();
  const Vec4 q0 = scaled(before.orientation.back());
  Vec4 q1 = scaled(after.orientation.front());
  if (q0.dot(q1) < 0.0) q1 = -q1;
  if (p0 == p1 && q0 == q1) return std::nullopt;
  return motion::straight_motion({p0, q0}, {p1, q1});
}

}  // namespace

std::optional<std::string> find_fault(std::span<const Segment> segments) {
  if (segments.empty()) return "segments: is empty, there is no path";
  for (std::size_t i = 0; i < segments.size(); ++i) {
    std::optional<std::string> fault =
        fault_in_times(segments[i], i == 0 ? nullptr : &segments[i - 1]);
    if (!fault) fault = fault_in_position(segments[i]);
    if (!fault) fault = fault_in_orientation(segments[i]);
    if (fault) return fmt::format("segments[{}].{}", i, *fault);
  }
  return std::nullopt;
}

double pose_distance_m(const Pose& a, const Pose& b, double body_radius_m) {
  const Vec4 qa = geometry::wxyz(a.orientation);
  const Vec4 qb = geometry::wxyz(b.orientation);
  // Quaternions an angle φ apart differ by 2·sin(φ/2) >= sin(φ), and turn by 2φ.
  const double sine = std::min(1.0, std::min((qa - qb).norm(), (qa + qb).norm()));
  return (a.position - b.position).norm() + 2.0 * body_radius_m * sine;
}

std::optional<std::string> find_jump(const motion::Path& path, double body_radius_m) {
  const std::span<const Segment> segments = path.segments();
  for (std::size_t i = 1; i < segments.size(); ++i) {
    const Pose before = motion::pose_at(segments[i - 1], 1.0);
    const double jump_m = pose_distance_m(before, motion::pose_at(segments[i], 0.0), body_radius_m);
    const double rounding_m = motion::corner_rounding_m(segments[i - 1], 1.0, body_radius_m) +
                              motion::corner_rounding_m(segments[i], 0.0, body_radius_m);
    const double agreement_m = kJoinAgreement * (before.position.norm() + body_radius_m);
    if (jump_m <= agreement_m + rounding_m) continue;
    return fmt::format("segments[{}]: begins {:.3g} m away from where segments[{}] ends", i, jump_m,
                       i - 1);
  }
  return std::nullopt;
}

std::vector<Bridge> bridges(const motion::Path& path) {
  std::vector<Bridge> found;
  const std::span<const Segment> segments = path.segments();
  for (std::size_t i = 1; i < segments.size(); ++i) {
    const std::optional<Segment> over = bridge(segments[i - 1], segments[i]);
    if (over) found.push_back({segments[i].t0_s, motion::Path({*over})});
  }
  return found;
}

std::vector<double> keyframe_misses_m(const motion::Path& path,
                                      std::span<const motion::Keyframe> keyframes,
                                      double body_radius_m) {
  std::vector<double> misses_m;
  misses_m.reserve(keyframes.size());
  for (const motion::Keyframe& keyframe : keyframes) {
    const Pose wanted{keyframe.pose.position, keyframe.pose.orientation.normalized()};
    misses_m.push_back(pose_distance_m(path.pose(keyframe.time_s), wanted, body_radius_m));
  }
  return misses_m;
}

}  // namespace camway::planning
