// SPDX-License-Identifier: MIT
#include "tools/demo/report.h"

#include <fmt/format.h>

#include <algorithm>

#include "daemon/motion/spline/interpolate.h"

namespace camway::demo {
namespace {

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

/// Returns the names of the objects that the answer has as witnesses of collisions, each once.
std::vector<std::string> objects_hit(const PlanResponse& response) {
  std::vector<std::string> names;
  for (const CollisionInterval& collision : response.collisions) {
    if (!collision.witness) continue;
    const std::string& object = collision.witness->object;
    if (std::find(names.begin(), names.end(), object) == names.end()) names.push_back(object);
  }
  return names;
}

std::string collided(const PlanResponse& response) {
  if (response.collisions.empty()) return response.path.empty() ? "-" : "nothing";
  const std::vector<std::string> objects = objects_hit(response);
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

std::string table_head() {
  return fmt::format(kRow, "request", "collided with", "inserted", "remaining", "status",
                     "planning", "round trip");
}

std::string table_row(const std::string& request, const PlanResponse& response) {
  return fmt::format(kRow, request, collided(response), count_inserted(response),
                     response.remaining.size(), to_string(response.status),
                     fmt::format("{:.0f} ms", response.timing.total_ms),
                     fmt::format("{:.0f} ms", 1000.0 * response.elapsed_s));
}

}  // namespace camway::demo
