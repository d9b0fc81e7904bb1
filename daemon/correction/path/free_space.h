// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "daemon/base/deadline.h"
#include "daemon/collision/interval.h"
#include "daemon/collision/probe.h"
#include "daemon/collision/query.h"
#include "daemon/correction/path/closeness.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/motion/path/straight_motion.h"
#include "daemon/scene/index/scene_index.h"

namespace camway::correction {

/// Collision queries for poses and straight motions, for searches that have no path yet. A *gap* is
/// the distance between the body and the scene less the required clearance, or the depth inside the
/// bounds if that is smaller; the body collides where it is 0 or less.
///
/// Not thread-safe: queries use buffers of the object.
class FreeSpace {
 public:
  explicit FreeSpace(const collision::Query& query, const OrientationPolicy& policy = {},
                     const Closeness& closeness = {});

  /// Returns true only if the gap of the body at `pose` is proved to be at least `margin_m`.
  [[nodiscard]] bool is_free(const motion::Pose& pose, double margin_m);

  /// Returns the gap of the body at `pose` as computed, at most `up_to_m`.
  [[nodiscard]] double gap_m(const motion::Pose& pose, double up_to_m);

  /// Returns about the nearest obstacle to the body at `pose`, and its gap as `distance_m`; nothing
  /// if all gaps are `up_to_m` or more. Ignores the insides of solids.
  [[nodiscard]] std::optional<scene::Nearest> nearest(const motion::Pose& pose, double up_to_m);
  /// Lower bound of the gap from the distance field alone; negative if the field cannot tell.
  [[nodiscard]] double gap_at_least_m(const motion::Pose& pose) const {
    return probe_.at_least_m(motion::standing_at(pose));
  }
  /// The probe, with the body placed at `pose`; valid until the next query.
  collision::Probe& placed(const motion::Pose& pose) {
    probe_.place(motion::standing_at(pose));
    return probe_;
  }
  /// Distance between the body's triangles and the scene at which the body collides.
  [[nodiscard]] double keep_m() const { return probe_.required_distance_m(); }
  /// Moves `pose` by the least translation that brings the body `margin_m` inside the bounds, as
  /// computed; returns `pose` bit for bit if it is inside already. A body larger than the bounds
  /// ends up beyond them on both sides.
  [[nodiscard]] motion::Pose within_bounds(const motion::Pose& pose, double margin_m);

  /// Returns the fraction of the straight motion at which the body first collides or its gap cannot
  /// be proved to be at least `margin_m`; nothing if that is proved for the whole motion.
  [[nodiscard]] std::optional<double> first_hit(const motion::SignedPose& from,
                                                const motion::SignedPose& to,
                                                double margin_m) const;
  /// Returns whether there is no such fraction. Cheaper than `first_hit` if there is one.
  [[nodiscard]] bool passes(const motion::SignedPose& from, const motion::SignedPose& to,
                            double margin_m) const;

  /// Gap of a ball about `point_W`, at most `up_to_m`; 0 or less where the ball collides. The sign
  /// is exact. To save time, the true distance of the centre may be as little as `kBallShare` times
  /// the computed one. A ball of radius `ball_radius_m()` holds the body in every orientation.
  [[nodiscard]] double ball_gap_m(const geometry::Vec3& point_W, double radius_m,
                                  double up_to_m) const;

  static constexpr double kBallShare = 0.8;

  /// Whether the ball, moved along the straight line, keeps the required clearance and stays within
  /// the bounds, as computed.
  [[nodiscard]] bool ball_passes(const geometry::Vec3& from_W, const geometry::Vec3& to_W,
                                 double radius_m) const;
  /// The same for one way after another near by. `met`: a triangle that is tried first, which
  /// changes no answer; set to what the ball meets.
  [[nodiscard]] bool ball_passes(const geometry::Vec3& from_W, const geometry::Vec3& to_W,
                                 double radius_m, std::optional<std::uint32_t>& met) const;

  /// Gap of the straight line between the two points, at most `up_to_m`.
  [[nodiscard]] double way_gap_m(const geometry::Vec3& from_W, const geometry::Vec3& to_W,
                                 double up_to_m) const;

  /// Returns the deepest contact of the body at `pose`, or one with an obstacle up to `beyond_m`
  /// away.
  [[nodiscard]] std::optional<collision::Witness> contact(const motion::Pose& pose,
                                                          double beyond_m);

  /// Centre, in the camera frame, of a ball that holds the body in every orientation, and its
  /// radius.
  [[nodiscard]] const geometry::Vec3& center_C() const { return center_C_; }
  [[nodiscard]] double ball_radius_m() const { return ball_radius_m_; }
  [[nodiscard]] geometry::Vec3 center_W(const motion::Pose& pose) const {
    return pose.position + pose.orientation * center_C_;
  }
  /// The pose with this orientation whose ball is centred at `center_W`.
  [[nodiscard]] motion::Pose pose_around(const geometry::Vec3& center_W,
                                         const geometry::Quat& orientation) const {
    return {center_W - orientation * center_C_, orientation};
  }
  /// Estimate of how far a point of the body moves between two poses: the metric of searches.
  [[nodiscard]] double distance_m(const motion::SignedPose& a, const motion::SignedPose& b) const;

  [[nodiscard]] const collision::Query& query() const { return query_; }
  [[nodiscard]] const collision::Obstacles& obstacles() const { return query_.obstacles; }
  [[nodiscard]] const motion::Body& body() const { return query_.body; }
  [[nodiscard]] const collision::DetectOptions& detect_options() const { return query_.options; }
  [[nodiscard]] const OrientationPolicy& policy() const { return policy_; }
  [[nodiscard]] const Closeness& closeness() const { return closeness_; }
  /// Whether corrections may change orientations.
  [[nodiscard]] bool may_turn() const { return may_turn_in(policy_); }
  /// Turns `wanted` about the centre of the body until it meets the orientation policy, compared
  /// with the pose `interpolated` of the interpolated path at the same time; returns `wanted` bit
  /// for bit if it meets the policy already.
  [[nodiscard]] motion::SignedPose allowed(const motion::SignedPose& wanted,
                                           const motion::Pose& interpolated) const;

 private:
  /// The query with `margin_m` more clearance, to the scene and to the bounds.
  [[nodiscard]] collision::Query with_margin(double margin_m) const;

  const collision::Query query_;
  OrientationPolicy policy_;
  Closeness closeness_;
  collision::Probe probe_;
  geometry::Vec3 center_C_;
  double ball_radius_m_ = 0.0;
};

}  // namespace camway::correction
