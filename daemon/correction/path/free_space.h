// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "daemon/base/deadline.h"
#include "daemon/collision/detect.h"
#include "daemon/collision/probe.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/motion/path/straight_motion.h"
#include "daemon/scene/index/scene_index.h"

namespace camway::correction {

/// Where the body may be: what searches ask about poses and straight motions before there is a
/// path. Not safe from several threads at once: it holds buffers.
class FreeSpace {
 public:
  /// Refers to all three, which must outlive it.
  FreeSpace(const collision::Obstacles& obstacles, const motion::Body& body,
            const collision::DetectOptions& detect, const OrientationPolicy& policy = {});

  /// Whether the body at `pose` keeps the required clearance and `margin_m` more, and that much
  /// within the bounds: proved.
  [[nodiscard]] bool is_free(const motion::Pose& pose, double margin_m);

  /// How much further than required the body at `pose` is from the scene, or how far it is inside
  /// the bounds if that is less, as computed, or `up_to_m` if it is that much; 0 or less where it
  /// collides.
  [[nodiscard]] double gap_m(const motion::Pose& pose, double up_to_m);

  /// The obstacle nearest to the body at `pose`, with how much further than required it is, about;
  /// nothing where everything is at least `up_to_m` away. What is inside a solid does not count.
  [[nodiscard]] std::optional<scene::Nearest> nearest(const motion::Pose& pose, double up_to_m);
  /// A bound of that gap at the cost of a look-up; below 0 where it does not tell.
  [[nodiscard]] double at_least_m(const motion::Pose& pose) const {
    return probe_.at_least_m(motion::standing_at(pose));
  }
  /// The body's triangles at `pose`; valid until the next question.
  std::span<const geometry::Triangle> placed(const motion::Pose& pose) {
    return probe_.place(motion::standing_at(pose));
  }
  /// Distance of the body's triangles from the scene at which it collides.
  [[nodiscard]] double keep_m() const { return probe_.keep_m(); }
  /// `pose`, moved as little as it takes to have the body within the bounds by `margin_m`, as
  /// computed; as it is, bit for bit, where that is so. Where the body is larger than the bounds it
  /// is beyond them on both sides.
  [[nodiscard]] motion::Pose within_bounds(const motion::Pose& pose, double margin_m);

  /// Where on the straight motion the body comes closer than the required clearance and
  /// `margin_m`, to the bounds than `margin_m`; nothing where it proved not to.
  [[nodiscard]] std::optional<double> first_hit(const motion::SignedPose& from,
                                                const motion::SignedPose& to, double margin_m);

  /// How much further than required a ball about `point_W` is from the scene, or inside the bounds
  /// if that is less, or `up_to_m` if it is that much; below 0 where it collides. The sign is
  /// right; of the distance of the ball's middle only `kBallShare` is sure, which spares time. One
  /// of radius `ball_radius_m()` holds the body in every orientation.
  [[nodiscard]] double ball_gap_m(const geometry::Vec3& point_W, double radius_m,
                                  double up_to_m) const;

  static constexpr double kBallShare = 0.8;

  /// Whether the ball keeps away from the scene and within the bounds, as computed, on the straight
  /// way between the two.
  [[nodiscard]] bool ball_passes(const geometry::Vec3& from_W, const geometry::Vec3& to_W,
                                 double radius_m) const;

  /// How much further than required the straight way between the two is from the scene, or inside
  /// the bounds if that is less, or `up_to_m` if it is that much.
  [[nodiscard]] double way_gap_m(const geometry::Vec3& from_W, const geometry::Vec3& to_W,
                                 double up_to_m) const;

  /// A deepest contact of the body at `pose`, or with what is up to `beyond_m` away.
  [[nodiscard]] std::optional<collision::Witness> contact(const motion::Pose& pose,
                                                          double beyond_m);

  /// Centre, in the camera frame, and radius of that ball.
  [[nodiscard]] const geometry::Vec3& center_C() const { return center_C_; }
  [[nodiscard]] double ball_radius_m() const { return ball_radius_m_; }
  [[nodiscard]] geometry::Vec3 center_W(const motion::Pose& pose) const {
    return pose.position + pose.orientation * center_C_;
  }
  /// The pose with that orientation that has the ball at `center_W`.
  [[nodiscard]] motion::Pose pose_around(const geometry::Vec3& center_W,
                                         const geometry::Quat& orientation) const {
    return {center_W - orientation * center_C_, orientation};
  }
  /// How far a point of the body moves between two poses, about: what searches measure ways by.
  [[nodiscard]] double distance_m(const motion::SignedPose& a, const motion::SignedPose& b) const;

  [[nodiscard]] const collision::Obstacles& obstacles() const { return obstacles_; }
  [[nodiscard]] const motion::Body& body() const { return body_; }
  [[nodiscard]] const collision::DetectOptions& detect() const { return detect_; }
  [[nodiscard]] const OrientationPolicy& policy() const { return policy_; }
  /// Whether corrections may change orientations.
  [[nodiscard]] bool may_turn() const { return may_turn_in(policy_); }
  /// `wanted`, turned about the middle of the body as far as the rule for orientations asks for; as
  /// it is, bit for bit, where it is allowed. `interpolated`: the interpolated path at that time.
  [[nodiscard]] motion::SignedPose allowed(const motion::SignedPose& wanted,
                                           const motion::Pose& interpolated) const;

 private:
  collision::Obstacles obstacles_;
  const motion::Body& body_;
  const collision::DetectOptions& detect_;
  OrientationPolicy policy_;
  collision::Probe probe_;
  geometry::Vec3 center_C_;
  double ball_radius_m_ = 0.0;
};

}  // namespace camway::correction
