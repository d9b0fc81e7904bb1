// SPDX-License-Identifier: MIT
#include <camway/camway.h>
#include <camway/client.h>

#include <algorithm>
#include <array>
#include <vector>

#include "client/c/scene_calls.h"
#include "client/c/sized.h"

namespace camway::c {
namespace {

camway_scan_map default_scan_map() {
  const SceneSensor defaults;
  camway_scan_map map{};
  map.hit_probability = defaults.hit_probability;
  map.miss_probability = defaults.miss_probability;
  map.least_probability = defaults.least_probability;
  map.most_probability = defaults.most_probability;
  map.max_range_m = defaults.max_range_m;
  return map;
}

SceneVoxels voxels_of(const camway_scan_map* pointer) {
  const camway_scan_map given = read_sized(pointer, default_scan_map(), "map");
  SceneVoxels voxels;
  voxels.resolution_m = given.resolution_m;
  voxels.unknown =
      given.unknown_is_occupied != 0 ? SceneMesh::Unknown::kOccupied : SceneMesh::Unknown::kFree;
  voxels.sensor = {given.hit_probability, given.miss_probability, given.least_probability,
                   given.most_probability, given.max_range_m};
  return voxels;
}

std::vector<std::array<double, 3>> points_of(const double* points_m, std::size_t num_points) {
  require_array(points_m, num_points, "points_m");
  std::vector<std::array<double, 3>> points(num_points);
  for (std::size_t i = 0; i < num_points; ++i) std::copy_n(points_m + 3 * i, 3, points[i].begin());
  return points;
}

}  // namespace
}  // namespace camway::c

using namespace camway::c;

camway_status camway_scan_map_init(camway_scan_map* map, size_t struct_size) {
  return guarded([&] {
    init_sized(default_scan_map(), map, struct_size);
    return CAMWAY_OK;
  });
}

camway_status camway_scene_put_scan_map(camway_client* client, const char* scene,
                                        const char* object, const camway_scan_map* map,
                                        const camway_pose* pose, camway_scene_answer** answer) {
  const auto shape = [&] { return voxels_of(map); };
  return put(client, scene, object, shape, pose, answer);
}

camway_status camway_scene_insert_scan(camway_client* client, const char* scene, const char* object,
                                       const double* points_m, size_t num_points,
                                       const double origin_m[3], camway_scene_answer** answer) {
  return ask_about_scenes(client, answer, [&](camway::Client& found) {
    require(origin_m, "origin_m");
    return found.insert_scan(text_of(scene, "scene"), text_of(object, "object"),
                             points_of(points_m, num_points),
                             {origin_m[0], origin_m[1], origin_m[2]});
  });
}

camway_status camway_scene_put_points(camway_client* client, const char* scene, const char* object,
                                      const double* points_m, size_t num_points, double cell_m,
                                      const camway_pose* pose, camway_scene_answer** answer) {
  const auto shape = [&] { return camway::ScenePoints{points_of(points_m, num_points), cell_m}; };
  return put(client, scene, object, shape, pose, answer);
}

camway_status camway_scene_export_map(camway_client* client, const char* scene, const char* file,
                                      camway_scene_answer** answer) {
  return ask_about_scenes(client, answer, [&](camway::Client& found) {
    return found.export_map_to(text_of(scene, "scene"), text_of(file, "file"));
  });
}
