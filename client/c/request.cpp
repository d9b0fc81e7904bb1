// SPDX-License-Identifier: MIT
#include "client/c/request.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "client/c/frame.h"
#include "client/c/sized.h"

namespace camway::c {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

static_assert(CAMWAY_BODY_SOLID_MESH == static_cast<int>(Body::Shape::kSolidMesh));
static_assert(CAMWAY_SAFEST == static_cast<int>(Objective::kSafest));
static_assert(CAMWAY_ORIENTATION_TARGET == static_cast<int>(Orientation::Policy::kTarget));

std::array<double, 3> vector_of(const double (&from)[3]) { return {from[0], from[1], from[2]}; }

camway_plan_request default_request() {
  const PlanRequest defaults;
  camway_plan_request request{};
  request.fov_x_rad = defaults.camera.fov_x_rad;
  request.fov_y_rad = defaults.camera.fov_y_rad;
  request.near_m = defaults.camera.near_m;
  std::fill_n(request.bounds_min_m, 3, -kInfinity);
  std::fill_n(request.bounds_max_m, 3, kInfinity);
  request.max_turn_rad = -1.0;
  request.max_inserted_keyframes = -1;
  return request;
}

std::vector<Keyframe> keyframes_of(const camway_plan_request& given) {
  require_array(given.keyframes, given.num_keyframes, "keyframes");
  std::vector<Keyframe> keyframes(given.num_keyframes);
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const camway_keyframe& from = given.keyframes[i];
    if (given.untimed == 0) keyframes[i].time_s = from.time_s;
    keyframes[i].position_m = vector_of(from.position_m);
    std::copy_n(from.orientation_wxyz, 4, keyframes[i].orientation_wxyz.begin());
    if (given.images != nullptr) std::copy_n(given.images + 4 * i, 4, keyframes[i].image.begin());
  }
  return keyframes;
}

std::vector<Body::Point> vertices_of(const camway_body& given) {
  require_array(given.vertices_m, given.num_vertices, "body.vertices_m");
  std::vector<Body::Point> vertices(given.num_vertices);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    std::copy_n(given.vertices_m + 3 * i, 3, vertices[i].begin());
  }
  return vertices;
}

std::vector<std::vector<Body::Point>> pieces_of(const camway_body& given) {
  require_array(given.piece_sizes, given.num_pieces, "body.piece_sizes");
  const std::vector<Body::Point> points = vertices_of(given);
  std::vector<std::vector<Body::Point>> pieces(given.num_pieces);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::size_t count = given.piece_sizes[i];
    if (count > points.size() - begin) break;
    const auto first = points.begin() + static_cast<std::ptrdiff_t>(begin);
    pieces[i].assign(first, first + static_cast<std::ptrdiff_t>(count));
    begin += count;
  }
  if (begin == points.size() &&
      (pieces.empty() || pieces.back().size() == given.piece_sizes[pieces.size() - 1])) {
    return pieces;
  }
  throw Refusal{CAMWAY_INVALID, "body.piece_sizes: their sum is not body.num_vertices"};
}

Body body_of(const camway_body* pointer) {
  if (pointer == nullptr) return {};
  const camway_body given = read_sized(pointer, camway_body{}, "body");
  require_choice(given.shape, CAMWAY_BODY_SOLID_MESH, "body.shape");
  Body body;
  body.shape = static_cast<Body::Shape>(given.shape);
  switch (body.shape) {
    case Body::Shape::kCamera:
      break;
    case Body::Shape::kBox:
      return Body::box(vector_of(given.size_m), vector_of(given.center_m));
    case Body::Shape::kSphere:
      return Body::sphere(given.radius_m, vector_of(given.center_m));
    case Body::Shape::kConvex:
      body.pieces_m = pieces_of(given);
      break;
    case Body::Shape::kMesh:
    case Body::Shape::kSolidMesh:
      body.vertices_m = vertices_of(given);
      require_array(given.triangles, given.num_triangles, "body.triangles");
      body.triangles.resize(given.num_triangles);
      for (std::size_t i = 0; i < body.triangles.size(); ++i) {
        std::copy_n(given.triangles + 3 * i, 3, body.triangles[i].begin());
      }
      break;
  }
  return body;
}

Orientation orientation_of(const camway_plan_request& given) {
  require_choice(given.orientation, CAMWAY_ORIENTATION_TARGET, "orientation");
  Orientation orientation;
  orientation.policy = static_cast<Orientation::Policy>(given.orientation);
  orientation.up = vector_of(given.up);
  orientation.target_m = vector_of(given.target_m);
  orientation.cone_rad = given.cone_rad;
  // A NaN goes on to the daemon, which refuses it.
  if (!(given.max_turn_rad < 0.0)) orientation.max_turn_rad = given.max_turn_rad;
  return orientation;
}

Bounds bounds_of(const camway_plan_request& given) {
  Bounds bounds;
  for (std::size_t i = 0; i < 3; ++i) {
    if (given.bounds_min_m[i] != -kInfinity) bounds.min_m[i] = given.bounds_min_m[i];
    if (given.bounds_max_m[i] != kInfinity) bounds.max_m[i] = given.bounds_max_m[i];
  }
  return bounds;
}

}  // namespace

PlanRequest request_of(const camway_plan_request* pointer) {
  const camway_plan_request given = read_sized(pointer, default_request(), "request");
  require_choice(given.objective, CAMWAY_SAFEST, "objective");
  require_choice(given.priority + 1, 2, "priority + 1");
  PlanRequest request;
  request.scene = text_of(given.scene, "scene");
  request.camera = {given.fov_x_rad, given.fov_y_rad, given.near_m};
  request.body = body_of(given.body);
  request.keyframes = keyframes_of(given);
  if (given.frame != nullptr) request.frame = frame_of(*given.frame);
  request.default_speed_m_per_s = given.default_speed_m_per_s;
  request.viewing_distance_m = given.viewing_distance_m;
  request.method = optional_text(given.method);
  request.priority = static_cast<Priority>(given.priority);
  request.progress_period_s = given.progress_period_s;
  request.least_revision = given.least_revision;
  request.deadline_s = given.deadline_s;
  request.interval_tolerance_m = given.interval_tolerance_m;
  request.clearance_m = given.clearance_m;
  if (given.max_inserted_keyframes >= 0)
    request.max_inserted_keyframes = given.max_inserted_keyframes;
  request.objective = static_cast<Objective>(given.objective);
  request.orientation = orientation_of(given);
  request.limits = {given.max_speed_m_per_s, given.max_acceleration_m_per_s2,
                    given.max_turn_rate_rad_per_s, given.may_retime != 0};
  request.bounds = bounds_of(given);
  request.max_shrink = given.max_shrink;
  request.repair_keyframes = given.repair_keyframes != 0;
  request.clearance_profile = given.clearance_profile != 0;
  request.seed = given.seed;
  return request;
}

}  // namespace camway::c

using namespace camway::c;

camway_status camway_plan_request_init(camway_plan_request* request, size_t struct_size) {
  return guarded([&] {
    init_sized(default_request(), request, struct_size);
    return CAMWAY_OK;
  });
}

camway_status camway_body_init(camway_body* body, size_t struct_size) {
  return guarded([&] {
    init_sized(camway_body{}, body, struct_size);
    return CAMWAY_OK;
  });
}
