// SPDX-License-Identifier: MIT
#include "tests/bench/camway_side.h"

#include "daemon/collision/near_quad.h"
#include "daemon/motion/body/body.h"
#include "tests/bench/measure.h"

namespace camway::bench {

CamwayScene::CamwayScene(std::shared_ptr<const scene::Mesh> mesh) {
  index_build_s_ = timed_s([&] { index_ = scene::SceneIndex::build(mesh); });
  field_build_s_ = timed_s([&] {
    const auto built = scene::DistanceField::build(*mesh);
    if (built) field_ = std::make_shared<const scene::ClearanceField>(*built);
  });
}

collision::Obstacles CamwayScene::obstacles() const {
  collision::Obstacles obstacles(index_);
  obstacles.field = field_.get();
  return obstacles;
}

std::uint64_t CamwayScene::field_bytes() const {
  return field_ ? field_->statistics().memory_bytes : 0;
}

collision::DetectOptions default_options() { return {}; }

planning::PathCheck check_whole(const collision::Obstacles& obstacles, const motion::Path& path,
                                const motion::Camera& camera,
                                const collision::DetectOptions& options) {
  return planning::check_path({obstacles, motion::Body(camera), options}, path,
                              base::Deadline::never(), base::Deadline::never());
}

bool touches_at(const scene::SceneIndex& index, const motion::Camera& camera,
                const motion::Pose& pose) {
  for (const geometry::Triangle& half :
       collision::near_quad_triangles(motion::corners_W(motion::near_corners_C(camera), pose))) {
    if (index.intersects(half)) return true;
  }
  return false;
}

bool shown_colliding(const scene::SceneIndex& index, const motion::Camera& camera,
                     const motion::Path& path, const collision::CollisionInterval& interval) {
  constexpr int kLooks = 500;
  for (int i = 0; i <= kLooks; ++i) {
    const double share = static_cast<double>(i) / kLooks;
    const double time_s = interval.t_begin_s + share * (interval.t_end_s - interval.t_begin_s);
    if (touches_at(index, camera, path.pose(time_s))) return true;
  }
  return false;
}

}  // namespace camway::bench
