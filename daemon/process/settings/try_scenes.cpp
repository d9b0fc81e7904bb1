// SPDX-License-Identifier: MIT
#include "daemon/process/settings/try_scenes.h"

#include <fmt/format.h>

#include <cstdint>
#include <utility>

#include "daemon/scene/snapshot/snapshot.h"
#include "daemon/service/scenes/scene_rules.h"

namespace camway::process {

TriedScenes try_scenes(const std::vector<SceneArgument>& scenes,
                       const scene::SceneStoreLimits& limits) {
  TriedScenes tried;
  scene::SceneStore store(limits);
  const auto fail = [&tried](const SceneArgument& scene, const std::string& why,
                             scene::Limit limit) {
    tried.faults.push_back(fmt::format("{}: scene '{}': {}", scene.set_at, scene.name,
                                       service::with_setting(why, limit)));
  };
  for (const SceneArgument& scene : scenes) {
    scene::SnapshotResult read = scene::load_snapshot(scene.name, scene.file, scene.options);
    if (!read.snapshot) {
      fail(scene, read.error, read.limit);
      continue;
    }
    const std::uint64_t triangles = read.snapshot->report.triangles;
    const scene::StoreResult put = store.put(std::move(read.snapshot), {.operation = "load"});
    if (!put.snapshot) {
      fail(scene, put.error, put.limit);
      continue;
    }
    tried.found.push_back(fmt::format("scene '{}': {} triangles from {}", scene.name, triangles,
                                      scene.file.string()));
  }
  return tried;
}

}  // namespace camway::process
