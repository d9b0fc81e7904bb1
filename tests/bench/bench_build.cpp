// SPDX-License-Identifier: MIT
//
// Building the scene's index, and what it takes in memory, against Embree and FCL.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <optional>

#include <CLI/CLI.hpp>

#include "daemon/scene/scene_index.h"
#include "tests/bench/embree_peer.h"
#include "tests/bench/fcl_peer.h"
#include "tests/bench/measure.h"
#include "tests/bench/request_set.h"
#include "tests/bench/tiled_scene.h"

namespace camway::bench {
namespace {

using nlohmann::json;

enum Builder { kCamway, kCamwayOneThread, kEmbree, kEmbreeOneThread, kFcl };
constexpr std::size_t kBuilders = 5;
constexpr std::array<const char*, kBuilders> kBuilderNames{"camway", "camway_1_thread", "embree",
                                                           "embree_1_thread", "fcl"};

struct Options {
  std::vector<std::string> scenes{own_scenes() + "/gallery.obj", own_scenes() + "/maze.obj",
                                  own_scenes() + "/office.obj"};
  double scale = 1.0;
  std::size_t tile_to = 1'000'000;
  int rounds = 5;
  std::string json_file;
};

struct Builds {
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

std::vector<std::string> row(const std::string& name, std::size_t triangles, const Builds& b) {
  const auto text = [&](Builder k) { return duration_text(b.median_s[k]); };
  const auto bytes = [&](Builder k) { return fmt::format("{:.1f}", b.bytes_per_triangle[k]); };
  return {name,
          std::to_string(triangles),
          text(kCamway),
          text(kCamwayOneThread),
          text(kEmbree),
          text(kEmbreeOneThread),
          text(kFcl),
          ratio_text(b.median_s[kCamway] / b.median_s[kEmbree]),
          ratio_text(b.median_s[kFcl] / b.median_s[kCamway]),
          bytes(kCamway),
          bytes(kEmbree),
          bytes(kFcl)};
}

json to_json(const std::string& name, std::size_t triangles, const Builds& b) {
  json entry{{"scene", name},
             {"triangles", triangles},
             {"nodes", b.statistics.nodes},
             {"leaves", b.statistics.leaves},
             {"depth", b.statistics.depth},
             {"duplication", b.statistics.duplication},
             {"time_to_embree", b.median_s[kCamway] / b.median_s[kEmbree]},
             {"ratio_fcl", b.median_s[kFcl] / b.median_s[kCamway]}};
  for (std::size_t k = 0; k < kBuilders; ++k) {
    entry["seconds"][kBuilderNames[k]] = b.median_s[k];
    entry["bytes_per_triangle"][kBuilderNames[k]] = b.bytes_per_triangle[k];
  }
  return entry;
}

int run(const Options& options) {
  json document{{"benchmark", "build"}, {"machine", machine()}, {"rounds", options.rounds}};
  Table table({"scene", "triangles", "camway", "camway, 1 thread", "Embree", "Embree, 1 thread",
               "FCL", "camway / Embree", "FCL / camway", "camway B/tri", "Embree B/tri",
               "FCL B/tri"});
  const auto add = [&](const std::string& name, const std::shared_ptr<const scene::Mesh>& mesh) {
    const Builds builds = measure(mesh, options.rounds);
    table.add(row(name, mesh->triangles.size(), builds));
    document["scenes"].push_back(to_json(name, mesh->triangles.size(), builds));
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
  table.print();
  const std::string error = write_json(options.json_file, document);
  if (!error.empty()) fmt::print(stderr, "bench_build: {}\n", error);
  return error.empty() ? 0 : 1;
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
  app.add_option("--rounds", options.rounds, "repetitions")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--json", options.json_file, "write all numbers to this file");
  CLI11_PARSE(app, argc, argv);
  return camway::bench::run(options);
}
