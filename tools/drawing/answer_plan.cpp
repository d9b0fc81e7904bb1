// SPDX-License-Identifier: MIT
#include "tools/drawing/answer_plan.h"

#include <fmt/format.h>

#include <cstddef>
#include <utility>
#include <vector>

#include "daemon/motion/body/body.h"
#include "daemon/motion/spline/interpolate.h"

namespace camway::draw {
namespace {

/// Samples of a path: dense enough to be drawn as a line on a page.
constexpr std::size_t kPageSamples = 1500;

std::vector<motion::Keyframe> given_keyframes(const planning::PlanResult& result) {
  std::vector<motion::Keyframe> given = result.keyframes;
  std::erase_if(given, [](const motion::Keyframe& keyframe) {
    return keyframe.origin == motion::KeyframeOrigin::kInserted;
  });
  return given;
}

/// Returns points whose convex hull is that of the triangles; the corners of their box if there are
/// many.
std::vector<geometry::Vec3> outline_points_C(const motion::Body& body) {
  constexpr std::size_t kMostTriangles = 2000;  // the outline is drawn anew at each keyframe
  std::vector<geometry::Vec3> points_C;
  if (body.triangles_C().size() <= kMostTriangles) {
    for (const geometry::Triangle& triangle : body.triangles_C()) {
      points_C.insert(points_C.end(), triangle.begin(), triangle.end());
    }
    return points_C;
  }
  constexpr int kBoxCorners = 8;
  for (int i = 0; i < kBoxCorners; ++i) {
    points_C.push_back(body.box_C().corner(static_cast<geometry::Box::CornerType>(i)));
  }
  return points_C;
}

}  // namespace

void set_body(const planning::PlanRequest& request, FloorPlan& plan) {
  if (const motion::Camera* const camera = planning::moving_camera(request)) {
    plan.corners_C = motion::near_corners_C(*camera);
    return;
  }
  const base::Result<motion::Body> body = motion::Body::make(planning::body_shape(request));
  if (!body) return;
  plan.body_C = outline_points_C(*body);
  plan.body_ball_m = body->ball_radius_m();
}

FloorPlan plan_of_answer(const planning::PlanRequest& request, const planning::PlanResult& result,
                         scene::Mesh mesh) {
  FloorPlan plan;
  plan.subtitle = fmt::format("{}: {}", planning::to_string(result.status), result.message);
  plan.mesh = std::move(mesh);
  set_body(request, plan);
  plan.keyframes = result.keyframes;
  plan.before = sample(motion::interpolate(given_keyframes(result)), kPageSamples);
  plan.after = sample(result.path, kPageSamples);
  plan.collisions = result.collisions;
  plan.remaining_collisions = result.remaining_collisions;
  for (const correction::Correction& correction : result.corrections) {
    if (correction.kind == correction::CorrectionKind::kNone) continue;
    plan.corrected.push_back({correction.t_begin_s, correction.t_end_s});
  }
  if (result.infeasibility) plan.barrier = barrier_of(*result.infeasibility, plan.mesh);
  return plan;
}

}  // namespace camway::draw
