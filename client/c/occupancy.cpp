// SPDX-License-Identifier: MIT
#include <camway/camway.h>
#include <camway/client.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "client/c/handles.h"

namespace camway::c {
namespace {

/// The i-th of points that follow each other as three numbers each.
std::array<double, 3> point_at(const double* points, std::size_t i) {
  return {points[3 * i], points[3 * i + 1], points[3 * i + 2]};
}

void write(const std::vector<bool>& from, std::uint8_t* target) {
  std::copy(from.begin(), from.end(), target);
}

void write(const std::vector<std::optional<double>>& from, double* target) {
  std::transform(from.begin(), from.end(), target, [](const std::optional<double>& distance) {
    return distance.value_or(std::numeric_limits<double>::infinity());
  });
}

/// Asks `count` queries that `query` makes of their number, and writes the answers.
template <class Query, class Answer, class Target, class Make>
camway_status ask_map(camway_client* client, const char* scene,
                      std::vector<Query> OccupancyBatch::*queries, Answer OccupancyAnswer::*answers,
                      std::size_t count, Target* target, const Make& query) {
  require_array(target, count, "the array of answers");
  const auto found = Handles::all().find(client);
  OccupancyBatch batch;
  batch.scene = text_of(scene, "scene");
  for (std::size_t i = 0; i < count; ++i) (batch.*queries).push_back(query(i));
  const OccupancyAnswer answer = found->occupancy(batch);
  if (answer.ok()) write(answer.*answers, target);
  return returned(answer.status, answer.error);
}

}  // namespace
}  // namespace camway::c

using namespace camway::c;

camway_status camway_occupancy_points(camway_client* client, const char* scene,
                                      const double* points_m, size_t count, uint8_t* occupied) {
  return guarded([&] {
    require_array(points_m, count, "points_m");
    return ask_map(client, scene, &camway::OccupancyBatch::points_m,
                   &camway::OccupancyAnswer::points_occupied, count, occupied,
                   [&](std::size_t i) { return point_at(points_m, i); });
  });
}

camway_status camway_occupancy_spheres(camway_client* client, const char* scene,
                                       const double* centers_m, const double* radii_m, size_t count,
                                       uint8_t* occupied) {
  return guarded([&] {
    require_array(centers_m, count, "centers_m");
    require_array(radii_m, count, "radii_m");
    return ask_map(client, scene, &camway::OccupancyBatch::spheres,
                   &camway::OccupancyAnswer::spheres_occupied, count, occupied, [&](std::size_t i) {
                     return camway::OccupancySphere{point_at(centers_m, i), radii_m[i]};
                   });
  });
}

camway_status camway_occupancy_boxes(camway_client* client, const char* scene, const double* min_m,
                                     const double* max_m, size_t count, uint8_t* occupied) {
  return guarded([&] {
    require_array(min_m, count, "min_m");
    require_array(max_m, count, "max_m");
    return ask_map(client, scene, &camway::OccupancyBatch::boxes,
                   &camway::OccupancyAnswer::boxes_occupied, count, occupied, [&](std::size_t i) {
                     return camway::OccupancyBox{point_at(min_m, i), point_at(max_m, i)};
                   });
  });
}

camway_status camway_occupancy_rays(camway_client* client, const char* scene,
                                    const double* origins_m, const double* directions,
                                    const double* ranges_m, size_t count, double* hits_m) {
  return guarded([&] {
    require_array(origins_m, count, "origins_m");
    require_array(directions, count, "directions");
    require_array(ranges_m, count, "ranges_m");
    return ask_map(
        client, scene, &camway::OccupancyBatch::rays, &camway::OccupancyAnswer::rays_hit_m, count,
        hits_m, [&](std::size_t i) {
          return camway::OccupancyRay{point_at(origins_m, i), point_at(directions, i), ranges_m[i]};
        });
  });
}

camway_status camway_occupancy_distances(camway_client* client, const char* scene,
                                         const double* points_m, const double* max_m, size_t count,
                                         double* distances_m) {
  return guarded([&] {
    require_array(points_m, count, "points_m");
    require_array(max_m, count, "max_m");
    return ask_map(client, scene, &camway::OccupancyBatch::distances,
                   &camway::OccupancyAnswer::distances_m, count, distances_m, [&](std::size_t i) {
                     return camway::OccupancyDistance{point_at(points_m, i), max_m[i]};
                   });
  });
}

camway_status camway_occupancy_moves(camway_client* client, const char* scene, const double* from_m,
                                     const double* to_m, const double* radii_m, size_t count,
                                     double* hits_m) {
  return guarded([&] {
    require_array(from_m, count, "from_m");
    require_array(to_m, count, "to_m");
    require_array(radii_m, count, "radii_m");
    return ask_map(
        client, scene, &camway::OccupancyBatch::sphere_paths,
        &camway::OccupancyAnswer::sphere_paths_hit_m, count, hits_m, [&](std::size_t i) {
          return camway::OccupancySpherePath{point_at(from_m, i), point_at(to_m, i), radii_m[i]};
        });
  });
}
