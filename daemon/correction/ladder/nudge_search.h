// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "daemon/correction/ladder/nudge.h"
#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/free_space.h"

namespace camway::correction {

/// A change of poses: direction of the translation, or axis of the turn, and amount.
struct Nudge {
  geometry::Vec3 direction_W;
  double amount = 0.0;  ///< metres or radians
};

/// Measures which changes of poses free the body at a collision: for a fan of directions, or for
/// the camera's axes, the least amount. Poses are sampled in the middle of the collisions, and
/// beside it, where less is needed, since the ends of a collision are free. Not thread-safe.
class NudgeSearch {
 public:
  /// Refers to `problem` and `space`, which must outlive it.
  NudgeSearch(const Problem& problem, std::span<const collision::CollisionInterval> collisions,
              NudgeKind kind, FreeSpace& space);

  /// Returns the nudges that free the samples with the largest margin that any can keep, the
  /// smallest first; few, since each costs a path.
  std::vector<Nudge> smallest();

  /// Number of directions that were tried.
  [[nodiscard]] std::int32_t directions() const { return directions_; }
  /// Time of the middle of the interval to correct.
  [[nodiscard]] double middle_s() const { return middle_s_; }
  /// The pose of the path at that time.
  [[nodiscard]] const motion::SignedPose& middle_pose() const { return samples_[0].pose; }
  /// That pose after the nudge, as far as the orientation policy allows.
  [[nodiscard]] motion::SignedPose nudged_middle(const Nudge& nudge) const {
    return nudged(samples_[0], nudge.direction_W, nudge.amount);
  }

 private:
  struct Sample {
    motion::SignedPose pose;
    motion::Pose interpolated;
    double share;  ///< share of the amount that is needed here
  };

  void add_sample(double time_s, double share);
  /// The sample moved or turned by `amount`, as far as the orientation policy allows.
  [[nodiscard]] motion::SignedPose nudged(const Sample& sample, const geometry::Vec3& direction_W,
                                          double amount) const;
  [[nodiscard]] motion::SignedPose moved_or_turned(const motion::SignedPose& pose,
                                                   const geometry::Vec3& direction_W,
                                                   double amount) const;
  [[nodiscard]] bool is_enough(const geometry::Vec3& direction_W, double amount, double margin_m);
  /// Returns about the least amount in that direction that frees the samples; nothing if none up to
  /// `limit` does.
  std::optional<double> least_amount(const geometry::Vec3& direction_W, double limit,
                                     double margin_m);
  /// Whether the nudged body is, in the middle, within a closed surface that it was outside of. No
  /// bump leads there, although the pose is free of triangles.
  [[nodiscard]] bool leads_inside(const Nudge& nudge) const;
  /// The largest amount that is tried.
  [[nodiscard]] double farthest() const;
  [[nodiscard]] std::vector<geometry::Vec3> directions_W();
  /// The axes of the camera, or the axes that keep it level if the policy demands that.
  [[nodiscard]] std::vector<geometry::Vec3> axes_W(const geometry::Quat& orientation) const;
  /// Direction of the path at the collision.
  [[nodiscard]] geometry::Vec3 way_W() const;
  /// Along the normal of the deepest contact, and away from its point.
  [[nodiscard]] std::vector<geometry::Vec3> contact_directions_W();

  const Problem& problem_;
  const NudgeKind kind_;
  FreeSpace& space_;
  const double middle_s_;
  const double radius_m_;
  std::vector<Sample> samples_;  ///< the first is the middle
  std::int32_t directions_ = 0;
};

}  // namespace camway::correction
