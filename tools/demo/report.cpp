// SPDX-License-Identifier: MIT
#include "tools/demo/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "daemon/collision/near_quad.h"
#include "daemon/geometry/triangle_intersection.h"
#include "daemon/motion/spline/interpolate.h"

namespace camway::demo {
namespace {

/// Number of steps of a collision interval for finding the objects that are hit.
constexpr int kStepsPerInterval = 24;
constexpr std::size_t kMostNames = 2;

motion::Keyframe to_motion(const PathKeyframe& keyframe) {
  motion::Keyframe converted;
  converted.time_s = keyframe.time_s;
  const auto& p = keyframe.position_m;
  const auto& q = keyframe.orientation_wxyz;
  converted.pose = {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}};
  converted.origin =
      keyframe.inserted ? motion::KeyframeOrigin::kInserted : motion::KeyframeOrigin::kGiven;
  converted.is_repaired = keyframe.repaired;
  return converted;
}

/// Returns triangles of the filled quadrilateral and of the sides of the volume that it sweeps to
/// the next pose. The sides are necessary: the quadrilateral touches a parallel wall for one
/// instant only, which is between two poses.
using Step = std::vector<geometry::Triangle>;

Step step_between(const motion::Corners& from, const motion::Corners& to) {
  const std::array<geometry::Triangle, 2> quad = collision::near_quad_triangles(from);
  Step step(quad.begin(), quad.end());
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::size_t next = (i + 1) % from.size();
    step.push_back({from[i], from[next], to[i]});
    step.push_back({from[next], to[next], to[i]});
  }
  return step;
}

bool touches(const scene::Mesh& mesh, const scene::MeshObject& object, const Step& step,
             const geometry::Box& step_bounds) {
  for (std::uint32_t i = 0; i < object.triangle_count; ++i) {
    const geometry::Triangle triangle = mesh.triangle(object.first_triangle + i);
    if (!geometry::bounds(triangle).intersects(step_bounds)) continue;
    if (std::any_of(step.begin(), step.end(), [&](const geometry::Triangle& swept) {
          return geometry::triangles_touch(triangle, swept);
        })) {
      return true;
    }
  }
  return false;
}

/// Adds the names of the objects that the step touches to `names`, each once.
void add_names(const scene::Mesh& mesh, const Step& step, std::vector<std::string>& names) {
  geometry::Box bounds;
  for (const geometry::Triangle& triangle : step) bounds.extend(geometry::bounds(triangle));
  for (const scene::MeshObject& object : mesh.objects) {
    if (std::find(names.begin(), names.end(), object.name) != names.end()) continue;
    if (touches(mesh, object, step, bounds)) names.push_back(object.name);
  }
}

std::string collided(const PlanResponse& response, const std::vector<std::string>& objects) {
  if (response.collisions.empty()) return response.path.empty() ? "-" : "nothing";
  std::string text = fmt::format("{} x", response.collisions.size());
  for (std::size_t i = 0; i < std::min(kMostNames, objects.size()); ++i) {
    text += (i == 0 ? " " : ", ") + objects[i];
  }
  if (objects.size() > kMostNames) text += fmt::format(" + {} more", objects.size() - kMostNames);
  return text;
}

std::size_t count_inserted(const PlanResponse& response) {
  return static_cast<std::size_t>(
      std::count_if(response.keyframes.begin(), response.keyframes.end(),
                    [](const PathKeyframe& keyframe) { return keyframe.inserted; }));
}

constexpr const char* kRow = "{:<24} {:<51} {:>8} {:>9} {:<10} {:>9} {:>10}";

}  // namespace

std::vector<motion::Keyframe> all_keyframes(const PlanResponse& response) {
  std::vector<motion::Keyframe> keyframes;
  for (const PathKeyframe& keyframe : response.keyframes) keyframes.push_back(to_motion(keyframe));
  return keyframes;
}

std::vector<motion::Keyframe> given_keyframes(const PlanResponse& response) {
  std::vector<motion::Keyframe> keyframes = all_keyframes(response);
  std::erase_if(keyframes, [](const motion::Keyframe& keyframe) {
    return keyframe.origin == motion::KeyframeOrigin::kInserted;
  });
  return keyframes;
}

motion::Path path_before(const PlanResponse& response) {
  const std::vector<motion::Keyframe> given = given_keyframes(response);
  return given.size() < 2 ? motion::Path() : motion::interpolate(given);
}

motion::Camera to_motion(const Camera& camera) {
  return {camera.fov_x_rad, camera.fov_y_rad, camera.near_m};
}

std::vector<std::string> objects_hit(const scene::Mesh& mesh, const Camera& camera,
                                     const PlanResponse& response) {
  std::vector<std::string> names;
  const motion::Path before = path_before(response);
  if (before.empty()) return names;
  const motion::Corners corners_C = motion::near_corners_C(to_motion(camera));
  for (const CollisionInterval& interval : response.collisions) {
    const auto corners_at = [&](int step) {
      const double share = static_cast<double>(step) / kStepsPerInterval;
      const double time_s = interval.t_begin_s + share * (interval.t_end_s - interval.t_begin_s);
      return motion::corners_W(corners_C, before.pose(time_s));
    };
    for (int i = 0; i < kStepsPerInterval; ++i) {
      add_names(mesh, step_between(corners_at(i), corners_at(i + 1)), names);
    }
  }
  return names;
}

std::string table_head() {
  return fmt::format(kRow, "request", "collided with", "inserted", "remaining", "status",
                     "planning", "round trip");
}

std::string table_row(const std::string& request, const PlanResponse& response,
                      const std::vector<std::string>& objects) {
  return fmt::format(kRow, request, collided(response, objects), count_inserted(response),
                     response.remaining.size(), to_string(response.status),
                     fmt::format("{:.0f} ms", response.timing.total_ms),
                     fmt::format("{:.0f} ms", 1000.0 * response.elapsed_s));
}

}  // namespace camway::demo
