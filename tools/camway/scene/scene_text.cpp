// SPDX-License-Identifier: MIT
#include "tools/camway/scene/scene_text.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <ctime>
#include <utility>

#include "daemon/process/settings/bounds_text.h"
#include "tools/camway/common/daemon_failure.h"

namespace camway::tools {
namespace {

void print_object(const SceneObject& object) {
  const Pose& pose = object.pose;
  fmt::print(
      "  {}: {}, {} triangles, at [{:.6g}, {:.6g}, {:.6g}] m, turned [{:.6g}, {:.6g}, "
      "{:.6g}, {:.6g}], digest {}\n",
      object.name, object.kind, object.num_triangles, pose.position_m[0], pose.position_m[1],
      pose.position_m[2], pose.orientation_wxyz[0], pose.orientation_wxyz[1],
      pose.orientation_wxyz[2], pose.orientation_wxyz[3], object.digest);
}

void print_revision(const SceneRevision& revision) {
  constexpr std::int64_t kMicrosecondsPerSecond = 1'000'000;
  const std::time_t when = revision.utime / kMicrosecondsPerSecond;
  std::string what = revision.operation;
  if (!revision.object.empty()) what += " " + revision.object;
  if (revision.restored_revision > 0) what += fmt::format(" of {}", revision.restored_revision);
  fmt::print("  {}: {:%Y-%m-%dT%H:%M:%SZ}, {}, by {}\n", revision.revision, fmt::gmtime(when), what,
             revision.client_id.empty() ? "the daemon" : revision.client_id);
}

/// Returns the error of a daemon ("invalid: chord_error_m: ...") with the flag in place of the
/// member of the message. The values of other flags are checked before.
std::string named_as_flag(std::string error) {
  for (const auto& [member, flag] :
       {std::pair{"invalid: chord_error_m:", "--chord-error:"},
        std::pair{"invalid: occupancy_resolution_m:", "--occupancy:"}}) {
    if (error.starts_with(member)) return error.replace(0, std::strlen(member), flag);
  }
  return error;
}

}  // namespace

std::string bounds_note(const SceneInfo& scene) {
  const geometry::Bounds bounds =
      geometry::bounds_of({scene.body_bounds.min_m, scene.body_bounds.max_m});
  return bounds.any() ? ", bodies within " + process::bounds_text(bounds) : std::string();
}

void print_scene(const SceneInfo& scene) {
  fmt::print(
      "{} revision {}: {} triangles, [{:.3f}, {:.3f}, {:.3f}] to [{:.3f}, {:.3f}, {:.3f}] "
      "m, {}{}, digest {}\n",
      scene.name, scene.revision, scene.num_triangles, scene.bounds_min_m[0], scene.bounds_min_m[1],
      scene.bounds_min_m[2], scene.bounds_max_m[0], scene.bounds_max_m[1], scene.bounds_max_m[2],
      scene.occupancy_resolution_m > 0.0
          ? fmt::format("voxels of {} m", scene.occupancy_resolution_m)
          : "no occupancy map",
      bounds_note(scene), scene.digest);
}

ExitCode print_answer(const SceneAnswer& answer, const std::string& key_file) {
  if (!answer.ok()) return report_failure(answer.status, named_as_flag(answer.error), key_file);
  if (!answer.message.empty()) print_error(answer.message);
  if (!answer.scene.name.empty()) print_scene(answer.scene);
  for (const SceneInfo& scene : answer.scenes) print_scene(scene);
  for (const SceneObject& object : answer.objects) print_object(object);
  for (const SceneRevision& revision : answer.revisions) print_revision(revision);
  return ExitCode::kSuccess;
}

}  // namespace camway::tools
