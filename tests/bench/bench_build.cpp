// SPDX-License-Identifier: MIT
//
// Time and memory of building the scene's index, compared with Embree and FCL.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <optional>

#include "daemon/scene/index/scene_index.h"
#include "tests/bench/columns.h"
#include "tests/bench/command_line.h"
#include "tests/bench/peers/embree_peer.h"
#include "tests/bench/peers/fcl_peer.h"
#include "tests/bench/tiled_scene.h"

namespace camway::bench {
namespace {

using nlohmann::json;

enum Builder { kCamway, kCamwayOneThread, kEmbree, kEmbreeOneThread, kFcl };
constexpr std::size_t kBuilders = 5;
constexpr std::array<const char*, kBuilders> kBuilderNames{"camway", "camway_1_thread", "embree",
                                                           "embree_1_thread", "fcl"};
constexpr std::array<const char*, kBuilders> kBuilderTitles{"camway", "camway, 1 thread", "Embree",
                                                            "Embree, 1 thread", "FCL"};

struct Options {
  std::vector<std::string> scenes{own_scenes() + "/gallery.obj", own_scenes() + "/maze.obj",
                                  own_scenes() + "/office.obj"};
  double scale = 1.0;
  std::size_t tile_to = 1'000'000;
  int rounds = 5;
  std::string json_file;
};

struct Builds {
  std::string scene;
  std::size_t triangles = 0;
  std::array<double, kBuilders> median_s{};
  std::array<double, kBuilders> bytes_per_triangle{};
  scene::IndexStatistics statistics;
};

double build_index(const std::shared_ptr<const scene::Mesh>& mesh, unsigned threads,
                   scene::IndexStatistics& statistics) {
  scene::IndexOptions options;
  options.threads = threads;
  std::optional<scene::SceneIndex> index;
  const double taken_s = timed_s([&] { index.emplace(scene::SceneIndex::build(mesh, options)); });
  statistics = index->statistics();
  return taken_s;
}

double build_embree(const scene::Mesh& mesh, unsigned threads, double& bytes) {
  EmbreePeer embree(mesh, threads);
  const double taken_s = timed_s([&] { embree.build(); });
  bytes = static_cast<double>(embree.memory_bytes());
  return taken_s;
}

double build_fcl(const scene::Mesh& mesh, double& bytes) {
  FclPeer fcl(mesh);
  const double taken_s = timed_s([&] { fcl.build(); });
  bytes = static_cast<double>(fcl.memory_bytes());
  return taken_s;
}

Builds measure(const std::shared_ptr<const scene::Mesh>& mesh, int rounds) {
  Builds builds;
  builds.triangles = mesh->triangles.size();
  std::array<std::vector<double>, kBuilders> times_s;
  for (int round = -1; round < rounds; ++round) {  // round -1 warms up
    std::array<double, kBuilders> once_s{};
    std::array<double, kBuilders> bytes{};
    once_s[kCamway] = build_index(mesh, 0, builds.statistics);
    once_s[kEmbree] = build_embree(*mesh, 0, bytes[kEmbree]);
    once_s[kCamwayOneThread] = build_index(mesh, 1, builds.statistics);
    once_s[kEmbreeOneThread] = build_embree(*mesh, 1, bytes[kEmbreeOneThread]);
    once_s[kFcl] = build_fcl(*mesh, bytes[kFcl]);
    bytes[kCamway] = bytes[kCamwayOneThread] = static_cast<double>(builds.statistics.memory_bytes);
    for (std::size_t k = 0; k < kBuilders; ++k) {
      if (round >= 0) times_s[k].push_back(once_s[k]);
      builds.bytes_per_triangle[k] = bytes[k] / static_cast<double>(mesh->triangles.size());
    }
  }
  for (std::size_t k = 0; k < kBuilders; ++k) builds.median_s[k] = median(times_s[k]);
  return builds;
}

std::vector<Column<Builds>> columns() {
  using B = Builds;
  std::vector<Column<B>> columns{
      {"/scene", "scene", field(&B::scene)},
      {"/triangles", "triangles", field(&B::triangles)},
      {"/nodes", "", [](const B& b) -> json { return b.statistics.nodes; }},
      {"/leaves", "", [](const B& b) -> json { return b.statistics.leaves; }},
      {"/depth", "", [](const B& b) -> json { return b.statistics.depth; }},
      {"/duplication", "", [](const B& b) -> json { return b.statistics.duplication; }},
  };
  for (std::size_t k = 0; k < kBuilders; ++k) {
    columns.push_back({std::string("/seconds/") + kBuilderNames[k], kBuilderTitles[k],
                       [k](const B& b) -> json { return b.median_s[k]; }, as_duration});
  }
  columns.push_back({"/time_to_embree", "camway / Embree",
                     [](const B& b) -> json { return b.median_s[kCamway] / b.median_s[kEmbree]; },
                     as_ratio});
  columns.push_back({"/ratio_fcl", "FCL / camway",
                     [](const B& b) -> json { return b.median_s[kFcl] / b.median_s[kCamway]; },
                     as_ratio});
  for (std::size_t k = 0; k < kBuilders; ++k) {
    const bool alone = k != kCamwayOneThread && k != kEmbreeOneThread;
    columns.push_back({std::string("/bytes_per_triangle/") + kBuilderNames[k],
                       alone ? std::string(kBuilderTitles[k]) + " B/tri" : std::string(),
                       [k](const B& b) -> json { return b.bytes_per_triangle[k]; }, as_tenths});
  }
  return columns;
}

int run(const Options& options) {
  std::vector<Builds> all;
  const auto add = [&](const std::string& name, const std::shared_ptr<const scene::Mesh>& mesh) {
    all.push_back(measure(mesh, options.rounds));
    all.back().scene = name;
  };
  std::shared_ptr<const scene::Mesh> last;
  std::string last_name;
  for (const std::string& file : options.scenes) {
    last = load_mesh(file, options.scale);
    last_name = std::filesystem::path(file).stem().string();
    add(last_name, last);
  }
  if (options.tile_to > last->triangles.size()) {
    add(last_name + ", tiled", tiled(*last, options.tile_to));
  }
  fmt::print("\nmedians of {} builds; mesh and buffers ready before\n\n", options.rounds);
  print_table(columns(), all);
  json document = document_of("build");
  document["rounds"] = options.rounds;
  document["scenes"] = to_json(columns(), all);
  return finish(document, options.json_file);
}

}  // namespace
}  // namespace camway::bench

int main(int argc, char** argv) {
  CLI::App app{"Build time and memory of the scene's index against Embree and FCL"};
  camway::bench::Options options;
  app.add_option("--scene", options.scenes, "scenes; the last is tiled as well")
      ->capture_default_str();
  app.add_option("--scale", options.scale, "multiplies coordinates")->capture_default_str();
  app.add_option("--tile-to", options.tile_to, "triangles of the tiled scene at least; 0 for none")
      ->capture_default_str();
  camway::bench::add_rounds_option(app, options.rounds);
  camway::bench::add_json_option(app, options.json_file);
  CLI11_PARSE(app, argc, argv);
  return camway::bench::run(options);
}
