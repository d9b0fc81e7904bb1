// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "daemon/planning/stages/path_check.h"
#include "daemon/scene/field/clearance_field.h"
#include "daemon/scene/field/distance_field.h"
#include "daemon/scene/index/scene_index.h"
#include "tests/collision/crossing_campaign.h"

/// Camway's side of the comparisons, so that a change of an interface affects one place only. For
/// detection alone see `testing::certified_intervals`.
namespace camway::bench {

/// A scene as planning uses it: the index, and the distance field if there is one.
class CamwayScene {
 public:
  explicit CamwayScene(std::shared_ptr<const scene::Mesh> mesh);

  [[nodiscard]] const scene::SceneIndex& index() const { return index_; }
  /// Returns obstacles that refer to this object, which must outlive them.
  [[nodiscard]] collision::Obstacles obstacles() const;

  [[nodiscard]] double index_build_s() const { return index_build_s_; }
  [[nodiscard]] double field_build_s() const { return field_build_s_; }
  [[nodiscard]] std::uint64_t field_bytes() const;

 private:
  scene::SceneIndex index_;
  std::shared_ptr<const scene::ClearanceField> field_;
  double index_build_s_ = 0.0;  ///< wall-clock time with all threads
  double field_build_s_ = 0.0;
};

/// Returns the options of detection by the defaults of a request.
collision::DetectOptions default_options();

/// Returns what `camway check` finds about a path: intervals, or else a certificate with clearance.
planning::PathCheck check_whole(const collision::Obstacles& obstacles, const motion::Path& path,
                                const motion::Camera& camera,
                                const collision::DetectOptions& options);

/// Returns whether the filled quadrilateral touches the scene at the pose, in exact arithmetic.
bool touches_at(const scene::SceneIndex& index, const motion::Camera& camera,
                const motion::Pose& pose);

/// Returns whether some pose in the interval collides for certain. An interval may exist only
/// because the resolution of the search ended.
bool shown_colliding(const scene::SceneIndex& index, const motion::Camera& camera,
                     const motion::Path& path, const collision::CollisionInterval& interval);

}  // namespace camway::bench
