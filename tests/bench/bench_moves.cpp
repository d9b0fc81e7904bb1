// SPDX-License-Identifier: MIT
//
// Cost of a change of one object in a scene of a million triangles, occupancy mirror included.
#include <fmt/format.h>

#include <algorithm>

#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "tests/bench/columns.h"
#include "tests/bench/command_line.h"
#include "tests/bench/scene_changes.h"
#include "tests/bench/tiled_scene.h"

namespace camway::bench {
namespace {

using nlohmann::json;

struct Options {
  std::string scene = own_scenes() + "/office.obj";
  std::size_t least_triangles = 1'000'000;
  double occupancy_m = 0.1;
  int rounds = 200;
  std::string json_file;
};

/// A series of moves of one object.
struct Moves {
  std::string scene;
  std::size_t objects = 0;
  std::size_t triangles = 0;
  std::size_t moved = 0;  ///< triangles of the object that moves
  double median_s = 0.0;
  double p99_s = 0.0;
};

Moves measure(scene::SceneStore& store, const std::string& title, const std::string& object,
              int rounds) {
  std::vector<double> taken_s;
  for (int round = -5; round < rounds; ++round) {
    const double once_s =
        timed_s([&] { expect_taken(store.change("bench", move(object, round))); });
    if (round >= 0) taken_s.push_back(once_s);
  }
  const auto now = store.find("bench");
  return {title,           now->objects.size(),    now->index.size(), now->find(object)->triangles,
          median(taken_s), quantile(taken_s, 0.99)};
}

/// Measures a ball that moves about in one large mesh.
void building(const Options& options, const scene::Mesh& mesh, std::vector<Moves>& all) {
  scene::SnapshotOptions snapshot;
  snapshot.occupancy_resolution_m = options.occupancy_m;
  scene::SceneStore store;
  const scene::SnapshotResult made = scene::make_snapshot("bench", mesh, snapshot);
  if (!made.snapshot) throw std::runtime_error(made.error);
  expect_taken(store.put(made.snapshot));
  for (const double chord_m : {0.1, 1e-3, 1e-4, 1e-5}) {
    const scene::Mesh ball = *scene::sphere_mesh(0.5, chord_m);
    expect_taken(store.change("bench", put("ball", ball, {}, snapshot)));
    all.push_back(measure(store, "building and a ball", "ball", options.rounds));
  }
}

/// Measures one of a thousand objects that moves, with as many triangles in all.
void warehouse(const Options& options, std::vector<Moves>& all) {
  constexpr int kObjects = 1000;
  scene::SnapshotOptions snapshot;
  snapshot.occupancy_resolution_m = options.occupancy_m;
  scene::SceneStore store;
  expect_taken(store.put(scene::assemble("bench", 1, {}, snapshot)));
  const scene::Mesh ball = *scene::sphere_mesh(0.5, 1e-3);
  const auto count = static_cast<int>(options.least_triangles / ball.triangles.size() + 1);
  for (int i = 0; i < std::max(count, kObjects); ++i) {
    const geometry::Vec3 at(2.0 * (i % 32), 1.0, 2.0 * (i / 32));
    expect_taken(store.change("bench", put(fmt::format("ball{:04}", i), ball, at, snapshot)));
  }
  all.push_back(measure(store, "balls in rows", "ball0500", options.rounds));
}

int run(const Options& options) {
  std::vector<Moves> all;
  // The mesh gets finer instead of larger, because the mirror of so many buildings exceeds the
  // limit of a map.
  building(options, *refined(*load_mesh(options.scene, 1.0), options.least_triangles), all);
  warehouse(options, all);
  using M = Moves;
  const std::vector<Column<M>> columns{
      {"/scene", "scene", field(&M::scene)},
      {"/objects", "objects", field(&M::objects)},
      {"/triangles", "triangles", field(&M::triangles)},
      {"/moved", "moved triangles", field(&M::moved)},
      {"/median_s", "move, median", field(&M::median_s), as_duration},
      {"/p99_s", "p99", field(&M::p99_s), as_duration},
  };
  fmt::print("\n{} moves each, to the new revision in force, mirror of {} m included\n\n",
             options.rounds, options.occupancy_m);
  print_table(columns, all);
  json document = document_of("moves");
  document["scenes"] = to_json(columns, all);
  return finish(document, options.json_file);
}

}  // namespace
}  // namespace camway::bench

int main(int argc, char** argv) {
  CLI::App app{"What moving one object costs in a large scene, occupancy mirror included"};
  camway::bench::Options options;
  app.add_option("--scene", options.scene, "Its faces are divided for the scene of one large mesh");
  app.add_option("--triangles", options.least_triangles, "Of each scene")->capture_default_str();
  app.add_option("--occupancy", options.occupancy_m, "Voxels of the mirror, metres")
      ->capture_default_str();
  camway::bench::add_rounds_option(app, options.rounds);
  camway::bench::add_json_option(app, options.json_file);
  CLI11_PARSE(app, argc, argv);
  return camway::bench::run(options);
}
