// SPDX-License-Identifier: MIT
#include "daemon/correction/path/orientation_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace camway::correction {

namespace {

using collision::CollisionInterval;
using geometry::Quat;
using geometry::Vec3;
using motion::CubicPath;
using motion::Pose;
using motion::SegmentMotion;
using motion::Stretch;
using std::numbers::pi;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
/// Largest number of halvings of a common stretch; the rule counts as violated if it is not shown
/// by then.
constexpr int kMostHalvings = 10;
/// Change of an orientation that is attributed to rounding.
constexpr double kSameOrientation_rad = 1e-12;

double angle_rad(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// Angle θ of the rotation whose largest chord of the unit sphere is `chord` = 2·sin(θ/2).
double angle_of_chord_rad(double chord) { return 2.0 * std::asin(std::min(1.0, 0.5 * chord)); }

double turn_rad(const Stretch& stretch) { return angle_of_chord_rad(2.0 * stretch.turn_sine); }

double turn_between_rad(const Stretch& a, const Stretch& b) {
  // |A - B| = 2·√2·sin(θ/2) in Frobenius' norm.
  return angle_of_chord_rad((a.R_WC - b.R_WC).norm() / std::numbers::sqrt2);
}

// Let a and b be the middle orientations, A and B the rotations relative to them, whose first
// orders differ by the difference of the steps. The angle between A·a and B·b is at most that of a
// and b plus that of A and B.
double turn_room_rad(double limit_rad, const Stretch& now, const Stretch& before) {
  if (limit_rad >= pi || limit_rad <= 0.0) return kNoLimit;
  const double chord =
      (now.turn_step_W - before.turn_step_W).norm() + now.turn_bend + before.turn_bend;
  return limit_rad - turn_between_rad(now, before) - angle_of_chord_rad(chord);
}

/// Height of the tip of a camera axis along a stretch: `middle + s·slope`, s from -1 to 1, within
/// `bend`. It is the sine of the angle by which the axis points out of the horizontal plane.
struct Height {
  double middle = 0.0;
  double slope = 0.0;
  double bend = 0.0;

  [[nodiscard]] double low() const { return middle - std::abs(slope) - bend; }
  [[nodiscard]] double high() const { return middle + std::abs(slope) + bend; }
  [[nodiscard]] double largest() const { return std::max(-low(), high()); }
};

Height operator*(double sign, const Height& height) {
  return {sign * height.middle, sign * height.slope, height.bend};
}

Height height_of(const Stretch& stretch, Eigen::Index axis, const Vec3& up_W) {
  const Vec3 axis_W = stretch.R_WC.col(axis);
  return {up_W.dot(axis_W), up_W.dot(stretch.turn_step_W.cross(axis_W)), stretch.turn_bend};
}

double arc_sine(double sine) { return std::asin(std::clamp(sine, -1.0, 1.0)); }

/// Room of the condition that the angle of `now` is at no time further below that of `before` than
/// the allowance. Either of two conditions suffices. First: the sines differ by at most the
/// allowance times the cosine of the larger angle, which is the least slope of the sine between the
/// two. Second: the lowest angle of `now` is below the highest of `before` by at most the
/// allowance; this ignores that both may rise and fall together, but is exact for poses.
double above_room(const Height& now, const Height& before) {
  const double largest = std::min(1.0, std::max(now.largest(), before.largest()));
  const double together = now.middle - before.middle - std::abs(now.slope - before.slope) -
                          now.bend - before.bend +
                          kOrientationAllowance_rad * std::sqrt(1.0 - largest * largest);
  const double lowest_rad = arc_sine(before.high()) - kOrientationAllowance_rad;
  if (lowest_rad <= -0.5 * pi) return kNoLimit;
  return std::max(together, now.low() - std::sin(lowest_rad));
}

double level_room(const Vec3& up_W, const Stretch& now, const Stretch& before) {
  const Height across = height_of(now, 0, up_W);
  const Height across_before = height_of(before, 0, up_W);
  const Height horizon;
  // The absolute height before is at least `sign` times the height, and at least 0.
  const double sign = across_before.middle < 0.0 ? -1.0 : 1.0;
  const auto tilt_room = [&](double side) {
    return std::max(above_room(-side * across, -sign * across_before),
                    above_room(-side * across, horizon));
  };
  const Height top = height_of(now, 1, up_W);
  const double upright_room =
      std::max(above_room(top, horizon), above_room(top, height_of(before, 1, up_W)));
  return std::min({tilt_room(1.0), tilt_room(-1.0), upright_room});
}

struct Aim {
  double off_rad;   ///< angle between the view and the target
  double sway_rad;  ///< bound of its change within the stretch
};

Aim aim_at(const Vec3& target_W, const Stretch& stretch) {
  const Vec3 to_target_W = target_W - stretch.eye_W;
  const double distance_m = to_target_W.norm();
  const double shift_rad = stretch.travel_m == 0.0 ? 0.0
                           : stretch.travel_m < distance_m
                               ? std::asin(stretch.travel_m / distance_m)
                               : pi;
  return {angle_rad(-stretch.R_WC.col(2), to_target_W), turn_rad(stretch) + shift_rad};
}

double target_room_rad(const OrientationPolicy& policy, const Stretch& now, const Stretch& before) {
  if (policy.cone_rad >= pi) return kNoLimit;
  const Aim aim = aim_at(policy.target_W, now);
  const Aim was = aim_at(policy.target_W, before);
  return std::max(policy.cone_rad, was.off_rad - was.sway_rad + kOrientationAllowance_rad) -
         aim.off_rad - aim.sway_rad;
}

double room_of_rule(const OrientationPolicy& policy, const Stretch& now, const Stretch& before) {
  switch (policy.rule) {
    case OrientationRule::kFree:
    case OrientationRule::kKeep:
      return kNoLimit;
    case OrientationRule::kLevel:
      return level_room(policy.up_W, now, before);
    case OrientationRule::kTarget:
      return target_room_rad(policy, now, before);
  }
  return kNoLimit;
}

/// `wanted`, rolled about the view until it is as level as `before`.
Quat levelled(const Vec3& up_W, const Quat& wanted, const Quat& before) {
  const double across = up_W.dot(wanted * Vec3::UnitX());
  const double top = up_W.dot(wanted * Vec3::UnitY());
  const double across_before = std::abs(up_W.dot(before * Vec3::UnitX()));
  const double top_before = up_W.dot(before * Vec3::UnitY());
  // Half of the allowance is left for the spline between the knots.
  constexpr double kUsed_rad = 0.5 * kOrientationAllowance_rad;
  const bool is_turned_over = arc_sine(top) < std::min(0.0, arc_sine(top_before)) - kUsed_rad;
  const bool is_tilted = arc_sine(std::abs(across)) > arc_sine(across_before) + kUsed_rad;
  if (!is_tilted && !is_turned_over) return wanted;
  // After a roll by φ the tip of the x axis is at height A·cos(φ - φ₀), that of the y axis at
  // -A·sin(φ - φ₀).
  const double amplitude = std::hypot(across, top);
  const double phase_rad = std::atan2(top, across);
  const double height = std::copysign(std::min(across_before, std::abs(across)), across);
  const double rest_rad = std::acos(std::clamp(height / amplitude, -1.0, 1.0));
  const double upright_rad = std::remainder(phase_rad - rest_rad, 2.0 * pi);
  const double other_rad = std::remainder(phase_rad + rest_rad, 2.0 * pi);
  const bool other_is_allowed = -amplitude * std::sin(rest_rad) >= std::min(0.0, top_before);
  const bool takes_other = other_is_allowed && std::abs(other_rad) < std::abs(upright_rad);
  return wanted * Eigen::AngleAxisd(takes_other ? other_rad : upright_rad, Vec3::UnitZ());
}

/// `wanted`, with its view turned towards the target.
Quat targeted(const OrientationPolicy& policy, const Pose& wanted, const Pose& before) {
  const Vec3 view_W = wanted.orientation * -Vec3::UnitZ();
  const Vec3 to_target_W = policy.target_W - wanted.position;
  const double off_rad = angle_rad(view_W, to_target_W);
  const double off_before_rad =
      angle_rad(before.orientation * -Vec3::UnitZ(), policy.target_W - before.position);
  const double aimed_rad = std::max(kAimedShare * policy.cone_rad, off_before_rad);
  if (off_rad <= aimed_rad) return wanted.orientation;
  const Vec3 normal_W = view_W.cross(to_target_W);
  const Vec3 axis_W =
      normal_W.isZero() ? view_W.unitOrthogonal() : Vec3(normal_W / normal_W.norm());
  return Eigen::AngleAxisd(off_rad - aimed_rad, axis_W) * wanted.orientation;
}

Quat turned_less(double limit_rad, const Quat& wanted, const Quat& before) {
  const double aimed_rad = kAimedShare * limit_rad;
  const double angle_rad = wanted.angularDistance(before);
  if (limit_rad >= pi || angle_rad <= aimed_rad) return wanted;
  return before.slerp(aimed_rad / angle_rad, wanted);
}

Quat meeting_rule(const OrientationPolicy& policy, const Pose& wanted, const Pose& before) {
  switch (policy.rule) {
    case OrientationRule::kFree:
      return wanted.orientation;
    case OrientationRule::kKeep:
      return before.orientation;
    case OrientationRule::kLevel:
      return levelled(policy.up_W, wanted.orientation, before.orientation);
    case OrientationRule::kTarget:
      return targeted(policy, wanted, before);
  }
  return wanted.orientation;
}

/// The motions of two segments, compared over a time range that both cover.
class CommonStretch {
 public:
  CommonStretch(const motion::Segment& now, const motion::Segment& before)
      : now_(now), before_(before), now_motion_(now), before_motion_(before) {}

  /// Returns a part of the range in which the rule is violated or not shown to be met.
  [[nodiscard]] std::optional<CollisionInterval> breach(const OrientationPolicy& policy,
                                                        double t_begin_s, double t_end_s,
                                                        int halvings) const {
    const Stretch now = around(now_, now_motion_, t_begin_s, t_end_s);
    const Stretch before = around(before_, before_motion_, t_begin_s, t_end_s);
    if (least_rule_room(policy, now, before) >= 0.0) return std::nullopt;
    const double middle_s = 0.5 * (t_begin_s + t_end_s);
    const bool is_broken = !(least_rule_room(policy, standing(now), standing(before)) >= 0.0);
    if (is_broken || halvings == 0) return CollisionInterval{t_begin_s, t_end_s};
    if (auto found = breach(policy, t_begin_s, middle_s, halvings - 1)) return found;
    return breach(policy, middle_s, t_end_s, halvings - 1);
  }

 private:
  [[nodiscard]] static Stretch around(const motion::Segment& segment, const SegmentMotion& motion,
                                      double t_begin_s, double t_end_s) {
    const auto parameter = [&](double time_s) {
      return std::clamp((time_s - segment.t0_s) / (segment.t1_s - segment.t0_s), 0.0, 1.0);
    };
    return motion.around(parameter(t_begin_s), parameter(t_end_s));
  }

  /// The middle pose of `stretch`, without the motion.
  [[nodiscard]] static Stretch standing(const Stretch& stretch) {
    Stretch still;
    still.eye_W = stretch.eye_W;
    still.R_WC = stretch.R_WC;
    return still;
  }

  const motion::Segment& now_;
  const motion::Segment& before_;
  SegmentMotion now_motion_;
  SegmentMotion before_motion_;
};

}  // namespace

double least_rule_room(const OrientationPolicy& policy, const Stretch& now,
                       const Stretch& interpolated) {
  return std::min(room_of_rule(policy, now, interpolated),
                  turn_room_rad(policy.max_turn_rad, now, interpolated));
}

double rule_room(const OrientationPolicy& policy, const Pose& now, const Pose& interpolated) {
  if (!is_limited(policy)) return kNoLimit;
  return least_rule_room(policy, motion::standing_at(now), motion::standing_at(interpolated));
}

Pose allowed_pose(const OrientationPolicy& policy, const Pose& wanted, const Pose& interpolated,
                  const Vec3& pivot_C) {
  constexpr int kRounds = 3;  // turning about the pivot moves the eye, and rules may meet
  if (!is_limited(policy)) return wanted;
  const Vec3 pivot_W = wanted.position + wanted.orientation * pivot_C;
  Pose pose = wanted;
  for (int i = 0; i < kRounds; ++i) {
    const Quat orientation =
        turned_less(policy.max_turn_rad, meeting_rule(policy, pose, interpolated),
                    interpolated.orientation)
            .normalized();
    if (orientation.angularDistance(pose.orientation) <= kSameOrientation_rad) break;
    pose = {pivot_W - orientation * pivot_C, orientation};
  }
  return pose;
}

std::optional<CollisionInterval> first_breach(const OrientationPolicy& policy, const CubicPath& now,
                                              const CubicPath& interpolated, double t_begin_s,
                                              double t_end_s) {
  if (!is_limited(policy)) return std::nullopt;
  const motion::Path now_path = now.around(t_begin_s, t_end_s).path();
  const motion::Path before_path = interpolated.around(t_begin_s, t_end_s).path();
  auto before = before_path.segments().begin();
  for (const motion::Segment& segment : now_path.segments()) {
    // Skip the earlier segments that end before this one begins.
    while (before->t1_s <= segment.t0_s && before + 1 != before_path.segments().end()) ++before;
    for (auto other = before; other != before_path.segments().end(); ++other) {
      const double from_s = std::max({segment.t0_s, other->t0_s, t_begin_s});
      const double to_s = std::min({segment.t1_s, other->t1_s, t_end_s});
      if (other->t0_s >= segment.t1_s) break;
      if (!(from_s < to_s)) continue;
      const CommonStretch common(segment, *other);
      if (auto found = common.breach(policy, from_s, to_s, kMostHalvings)) return found;
    }
  }
  return std::nullopt;
}

}  // namespace camway::correction
