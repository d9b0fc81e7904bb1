// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "daemon/planning/check.h"
#include "daemon/scene/field/clearance_field.h"
#include "daemon/scene/field/distance_field.h"
#include "daemon/scene/index/scene_index.h"
#include "tests/collision/crossing_campaign.h"

/// Our own side of the comparisons, so that a change of an interface is mended in one place. For
/// detection alone see `testing::certified_intervals`.
namespace camway::bench {

/// A scene as planning has it: the index, and the distance field where there is one.
class CamwayScene {
 public:
  explicit CamwayScene(std::shared_ptr<const scene::Mesh> mesh);

  [[nodiscard]] const scene::SceneIndex& index() const { return index_; }
  /// Refers to this.
  [[nodiscard]] collision::Obstacles obstacles() const;

  [[nodiscard]] double index_build_s() const { return index_build_s_; }
  [[nodiscard]] double field_build_s() const { return field_build_s_; }
  [[nodiscard]] std::uint64_t field_bytes() const;

 private:
  scene::SceneIndex index_;
  std::shared_ptr<const scene::ClearanceField> field_;
  double index_build_s_ = 0.0;  ///< with all threads, by the wall
  double field_build_s_ = 0.0;
};

/// The defaults of a request.
collision::DetectOptions default_options();

/// All that `camway check` asks of a path: intervals, or else the certificate with its clearance.
planning::PathCheck check_whole(const collision::Obstacles& obstacles, const motion::Path& path,
                                const motion::Camera& camera,
                                const collision::DetectOptions& options);

/// Whether the filled quadrilateral touches the scene at the pose, exactly.
bool touches_at(const scene::SceneIndex& index, const motion::Camera& camera,
                const motion::Pose& pose);

/// Whether some pose in the interval collides without doubt; an interval may be there only because
/// the resolution ended.
bool shown_colliding(const scene::SceneIndex& index, const motion::Camera& camera,
                     const motion::Path& path, const collision::CollisionInterval& interval);

}  // namespace camway::bench
