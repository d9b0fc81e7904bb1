// SPDX-License-Identifier: MIT
//
// Cost of a scan into a large occupancy map, until the new revision is published.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/scene/voxels/map_scan.h"
#include "tests/bench/columns.h"
#include "tests/bench/command_line.h"
#include "tests/support/random.h"

namespace camway::bench {
namespace {

using geometry::Vec3;
using nlohmann::json;
using scene::SceneChange;
using scene::Voxel;
using scene::VoxelMap;
using scene::VoxelSet;

constexpr double kVoxelM = 0.05;
/// Voxels of a room, walls included. Those with the first index along each axis are walls or floor.
constexpr Voxel kRoom{160, 160, 60};

struct Options {
  int rooms = 3;
  int points = 5000;
  double reach_m = 6.0;
  int rounds = 30;
  std::string json_file;
};

/// A series of scans of one kind.
struct Scans {
  std::string kind;
  std::string mirror;
  std::size_t voxels = 0;
  std::size_t triangles = 0;
  std::size_t parts = 0;
  double changed_parts = 0.0;  ///< bricks that a scan changes, on average
  double map_s = 0.0;
  double median_s = 0.0;
  double p99_s = 0.0;
  double anew_s = 0.0;
};

bool is_wall(const Voxel& voxel, int rooms) {
  bool is_outside = false;
  bool is_inner = false;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    is_outside = is_outside || voxel[axis] == rooms * kRoom[axis];
    is_inner = is_inner || voxel[axis] % kRoom[axis] == 0;
  }
  return is_outside || is_inner || voxel[2] == 0 || voxel[2] == kRoom[2];
}

/// Returns a storey of rooms whose voxels are all known, or all except for one room.
std::shared_ptr<const VoxelMap> storey(const Options& options, bool is_all_known) {
  VoxelSet occupied;
  VoxelSet free;
  scene::VoxelMarker walls(occupied);
  scene::VoxelMarker rest(free);
  Voxel voxel{};
  for (voxel[2] = 0; voxel[2] <= kRoom[2]; ++voxel[2]) {
    for (voxel[1] = 0; voxel[1] <= options.rooms * kRoom[1]; ++voxel[1]) {
      for (voxel[0] = 0; voxel[0] <= options.rooms * kRoom[0]; ++voxel[0]) {
        const bool is_first_room = voxel[0] < kRoom[0] && voxel[1] < kRoom[1];
        if (is_first_room && !is_all_known) continue;
        (is_wall(voxel, options.rooms) ? walls : rest).insert(voxel);
      }
    }
  }
  return VoxelMap::build(kVoxelM, std::move(occupied), std::move(free), scene::UnknownSpace::kFree)
      .map;
}

/// Returns what a sensor in the first room sees of its walls, with an error of a centimetre in each
/// direction. At the end of one ray in fifty there is a moving object.
std::vector<Vec3> sight(const Options& options, const Vec3& origin, testing::Random& random) {
  std::vector<Vec3> points;
  while (points.size() < static_cast<std::size_t>(options.points)) {
    const Vec3 direction = random.direction();
    double way_m = options.reach_m;
    for (Eigen::Index k = 0; k < 3; ++k) {
      // The centre of the first voxel of the wall.
      const double wall_m =
          (direction[k] > 0.0 ? kRoom[static_cast<std::size_t>(k)] + 0.5 : 0.5) * kVoxelM;
      way_m = std::min(way_m, (wall_m - origin[k]) / direction[k]);
    }
    if (way_m >= options.reach_m) continue;
    if (points.size() % 50 == 0) way_m *= random.uniform(0.5, 1.0);
    points.push_back(origin + (way_m + random.uniform(-0.01, 0.01)) * direction);
  }
  return points;
}

void expect_taken(const scene::StoreResult& result) {
  if (!result.error.empty()) throw std::runtime_error(result.error);
}

SceneChange put(const std::shared_ptr<const VoxelMap>& map, const scene::ObjectOptions& options) {
  return {
      SceneChange::Kind::kPut,
      "map",
      scene::make_map_source(map, scene::report_of(*map, "bench"), options, geometry::Vec3::Zero()),
      {}};
}

std::size_t changed_parts(const scene::Snapshot& before, const scene::Snapshot& now) {
  auto old = before.find("map")->parts;
  std::ranges::sort(old);
  return static_cast<std::size_t>(std::ranges::count_if(
      now.find("map")->parts,
      [&](const auto& part) { return !std::ranges::binary_search(old, part); }));
}

/// Returns the time to make from scratch what a scan shares: sets of voxels, faces, trees, mirror.
double made_anew_s(const VoxelMap& map, const scene::ObjectOptions& options) {
  return timed_s([&] {
    VoxelSet occupied;
    VoxelSet free;
    scene::VoxelMarker walls(occupied);
    scene::VoxelMarker rest(free);
    map.occupied().for_each([&](const Voxel& voxel) { walls.insert(voxel); });
    map.free().for_each([&](const Voxel& voxel) { rest.insert(voxel); });
    const auto other = VoxelMap::build(map.resolution_m(), std::move(occupied), std::move(free),
                                       map.unknown(), map.limits(), map.sensor())
                           .map;
    scene::SceneStore store;
    expect_taken(store.put(scene::assemble("bench", 1, {}, options)));
    expect_taken(store.change("bench", put(other, options)));
  });
}

Scans measure(const Options& options, bool is_all_known, bool has_mirror) {
  scene::ObjectOptions with;
  if (has_mirror) with.occupancy_resolution_m = kVoxelM;
  scene::SceneStore store;
  expect_taken(store.put(scene::assemble("bench", 1, {}, with)));
  std::shared_ptr<const VoxelMap> map = storey(options, is_all_known);
  expect_taken(store.change("bench", put(map, with)));
  Scans scans;
  scans.kind = is_all_known ? "known room" : "unknown room";
  scans.mirror = has_mirror ? "yes" : "no";
  std::vector<double> map_s;
  std::vector<double> taken_s;
  for (int round = 0; round < options.rounds; ++round) {
    testing::Random random = testing::Random::of_case(4711, static_cast<std::uint64_t>(round));
    const Vec3 origin(random.uniform(2.0, 6.0), random.uniform(2.0, 6.0), 1.5);
    const std::vector<Vec3> points = sight(options, origin, random);
    const auto before = store.find("bench");
    const Stopwatch watch;
    const scene::VoxelMapResult next = scene::scanned(*map, {origin, points});
    if (!next.map) throw std::runtime_error(next.error);
    map_s.push_back(watch.seconds());
    expect_taken(store.change("bench", put(next.map, with)));
    taken_s.push_back(watch.seconds());
    map = next.map;
    scans.changed_parts += static_cast<double>(changed_parts(*before, *store.find("bench")));
  }
  scans.changed_parts /= options.rounds;
  scans.voxels = map->occupied().size() + map->free().size();
  scans.triangles = store.find("bench")->index.size();
  scans.parts = store.find("bench")->find("map")->parts.size();
  scans.map_s = median(map_s);
  scans.median_s = median(taken_s);
  scans.p99_s = quantile(taken_s, 0.99);
  scans.anew_s = made_anew_s(*map, with);
  return scans;
}

int run(const Options& options) {
  std::vector<Scans> all;
  for (const bool has_mirror : {false, true}) {
    for (const bool is_all_known : {true, false}) {
      all.push_back(measure(options, is_all_known, has_mirror));
    }
  }
  using S = Scans;
  const std::vector<Column<S>> columns{
      {"/kind", "scans of a", field(&S::kind)},
      {"/mirror", "mirror", field(&S::mirror)},
      {"/voxels", "known voxels", field(&S::voxels)},
      {"/triangles", "triangles", field(&S::triangles)},
      {"/parts", "parts", field(&S::parts)},
      {"/changed_parts", "changed by a scan", field(&S::changed_parts), as_tenths},
      {"/map_s", "map, median", field(&S::map_s), as_duration},
      {"/median_s", "in force, median", field(&S::median_s), as_duration},
      {"/p99_s", "p99", field(&S::p99_s), as_duration},
      {"/anew_s", "all made anew", field(&S::anew_s), as_duration},
  };
  fmt::print("\n{} scans each, of {} points within {} m, voxels of {} m\n\n", options.rounds,
             options.points, options.reach_m, kVoxelM);
  print_table(columns, all);
  json document = document_of("scan");
  document["scans"] = to_json(columns, all);
  return finish(document, options.json_file);
}

}  // namespace
}  // namespace camway::bench

int main(int argc, char** argv) {
  CLI::App app{"What a scan into a large occupancy map costs, to the new revision in force"};
  camway::bench::Options options;
  app.add_option("--rooms", options.rooms, "Along each side of the storey")->capture_default_str();
  app.add_option("--points", options.points, "Of a scan")->capture_default_str();
  app.add_option("--reach", options.reach_m, "No point is further, metres")->capture_default_str();
  camway::bench::add_rounds_option(app, options.rounds);
  camway::bench::add_json_option(app, options.json_file);
  CLI11_PARSE(app, argc, argv);
  return camway::bench::run(options);
}
