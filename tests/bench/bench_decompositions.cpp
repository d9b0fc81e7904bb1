// SPDX-License-Identifier: MIT
//
// Comparison of spatial decompositions. (The question of Ptacek & Johnstone 2006, section 5.)
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>

#include "daemon/collision/near_quad.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/bench/camway_side.h"
#include "tests/bench/columns.h"
#include "tests/bench/command_line.h"
#include "tests/bench/tiled_scene.h"
#include "tests/collision/crossing_random.h"

namespace camway::bench {
namespace {

using nlohmann::json;
using scene::Decomposition;

constexpr std::array<std::pair<const char*, Decomposition>, 3> kDecompositions{
    {{"octree", Decomposition::kOctree},
     {"k-d tree", Decomposition::kKdTree},
     {"bounding volumes", Decomposition::kBvh}}};

/// The distance within which most probes of a detection are decided.
constexpr double kWithin_m = 0.25;

struct Options {
  std::vector<std::string> scenes;
  double scale = 1.0;
  int rounds = 3;
  std::string json_file;
};

struct Measured {
  std::string scene{};
  std::size_t triangles = 0;
  std::string decomposition{};
  double build_s = 0.0;
  double build_one_thread_s = 0.0;
  double bytes_per_triangle = 0.0;
  double nearest_s = 0.0;
  double within_s = 0.0;
  double intersects_s = 0.0;
  double certify_s = 0.0;
};

// Random camera paths through the scene, free or colliding.
std::vector<BenchRequest> random_paths(const scene::Mesh& mesh, std::uint64_t seed) {
  constexpr int kPaths = 40;
  const geometry::Box box = mesh.bounds();
  std::vector<BenchRequest> requests;
  for (int i = 0; i < kPaths; ++i) {
    testing::CaseRandom random(seed, static_cast<std::uint64_t>(i));
    // The size of a room, with steps of at most a few metres.
    const double step_m = std::min(2.0, 0.2 * box.diagonal().norm());
    geometry::Vec3 position;
    for (Eigen::Index k = 0; k < 3; ++k) {
      position[k] = random.uniform(box.min()[k], box.max()[k]);
    }
    geometry::Quat orientation = random.rotation();
    std::vector<motion::Keyframe> keyframes;
    for (int k = 0; k < 5; ++k) {
      keyframes.push_back({static_cast<double>(k), {position, orientation}});
      position += step_m * random.direction();
      orientation =
          geometry::Quat(Eigen::AngleAxisd(random.uniform(0.0, 0.8), random.direction())) *
          orientation;
    }
    requests.push_back({fmt::format("random-{}", i),
                        "random",
                        {1.4, 1.0, 0.15},
                        motion::interpolate(keyframes),
                        keyframes.size()});
  }
  return requests;
}

using Body = std::array<geometry::Triangle, 2>;

std::vector<Body> poses_on(const std::vector<BenchRequest>& requests) {
  constexpr int kPosesPerPath = 50;
  std::vector<Body> bodies;
  for (const BenchRequest& request : requests) {
    const motion::Corners corners_C = motion::near_corners_C(request.camera);
    const double begin_s = request.path.begin_s();
    const double duration_s = request.path.end_s() - begin_s;
    for (int i = 0; i < kPosesPerPath; ++i) {
      const double time_s = begin_s + (i + 0.5) / kPosesPerPath * duration_s;
      bodies.push_back(
          collision::near_quad_triangles(motion::corners_W(corners_C, request.path.pose(time_s))));
    }
  }
  return bodies;
}

// The answers of one decomposition's queries, for comparison with the others.
struct Answers {
  double nearest_sum_m = 0.0;
  std::size_t within = 0;
  std::size_t intersecting = 0;
  /// Number of paths with collisions. The intervals are not compared: whether a short free part in
  /// one is resolved depends on the triangle that the index meets first.
  std::size_t colliding_paths = 0;
};

void measure_queries(const scene::SceneIndex& index, const std::vector<BenchRequest>& requests,
                     const std::vector<Body>& bodies, Measured& m, Answers& answers) {
  answers = {};
  m.nearest_s = warm_s([&] {
    answers.nearest_sum_m = 0.0;
    for (const Body& body : bodies) {
      const auto nearest = index.nearest(body, std::numeric_limits<double>::infinity());
      answers.nearest_sum_m += nearest ? nearest->distance_m : 0.0;
    }
  });
  m.within_s = warm_s([&] {
    answers.within = 0;
    for (const Body& body : bodies) answers.within += index.any_within(body, kWithin_m) ? 1U : 0U;
  });
  m.intersects_s = warm_s([&] {
    answers.intersecting = 0;
    for (const Body& body : bodies) {
      answers.intersecting += index.intersects(body[0]) || index.intersects(body[1]) ? 1U : 0U;
    }
  });
  m.certify_s = warm_s([&] {
    answers.colliding_paths = 0;
    for (const BenchRequest& request : requests) {
      const bool free = testing::certified_intervals(collision::Obstacles(index), request.path,
                                                     request.camera, default_options())
                            .empty();
      answers.colliding_paths += free ? 0U : 1U;
    }
  });
  const double queries = static_cast<double>(bodies.size());
  m.nearest_s /= queries;
  m.within_s /= queries;
  m.intersects_s /= queries;
  m.certify_s /= static_cast<double>(requests.size());
}

double build(const std::shared_ptr<const scene::Mesh>& mesh, Decomposition decomposition,
             unsigned threads, std::optional<scene::SceneIndex>& index) {
  scene::IndexOptions options;
  options.decomposition = decomposition;
  options.threads = threads;
  index.reset();
  return timed_s([&] { index.emplace(scene::SceneIndex::build(mesh, options)); });
}

Measured medians(const std::vector<Measured>& rounds) {
  const auto over = [&](double Measured::*field) {
    std::vector<double> values;
    for (const Measured& m : rounds) values.push_back(m.*field);
    return median(values);
  };
  return {rounds.front().scene,
          rounds.front().triangles,
          rounds.front().decomposition,
          over(&Measured::build_s),
          over(&Measured::build_one_thread_s),
          rounds.front().bytes_per_triangle,
          over(&Measured::nearest_s),
          over(&Measured::within_s),
          over(&Measured::intersects_s),
          over(&Measured::certify_s)};
}

struct NamedScene {
  std::string name;
  std::shared_ptr<const scene::Mesh> mesh;
};

std::vector<NamedScene> default_scenes() {
  const auto office = load_mesh(own_scenes() + "/office.obj", 1.0);
  return {{"gallery: thin things in a corridor", load_mesh(own_scenes() + "/gallery.obj", 1.0)},
          {"maze: large walls", load_mesh(own_scenes() + "/maze.obj", 1.0)},
          {"office: furnished rooms, tiled", tiled(*office, 250'000)},
          {"terrain: one fine surface", terrain(250'000)},
          {"dust: small triangles everywhere", dust(250'000, 7)}};
}

std::vector<Column<Measured>> columns() {
  using M = Measured;
  return {
      {"/scene", "scene", field(&M::scene)},
      {"/triangles", "triangles", field(&M::triangles)},
      {"/decomposition", "decomposition", field(&M::decomposition)},
      {"/build_seconds", "build", field(&M::build_s), as_duration},
      {"/build_1_thread_seconds", "build, 1 thread", field(&M::build_one_thread_s), as_duration},
      {"/bytes_per_triangle", "B/triangle", field(&M::bytes_per_triangle), as_tenths},
      {"/nearest_seconds", "nearest", field(&M::nearest_s), as_duration},
      {"/any_within_seconds", "any within 25 cm", field(&M::within_s), as_duration},
      {"/intersects_seconds", "intersects", field(&M::intersects_s), as_duration},
      {"/certify_seconds", "certify a path", field(&M::certify_s), as_duration},
  };
}

class Comparison {
 public:
  explicit Comparison(int rounds) : rounds_(rounds) {}

  // Returns false if two decompositions gave different answers.
  bool add(const NamedScene& scene) {
    const std::vector<BenchRequest> requests = random_paths(*scene.mesh, 3);
    const std::vector<Body> bodies = poses_on(requests);
    std::array<std::vector<Measured>, kDecompositions.size()> rounds;
    std::array<Answers, kDecompositions.size()> answers;
    for (int round = 0; round < rounds_; ++round) {
      for (std::size_t k = 0; k < kDecompositions.size(); ++k) {
        std::optional<scene::SceneIndex> index;
        Measured m{.scene = scene.name,
                   .triangles = scene.mesh->triangles.size(),
                   .decomposition = kDecompositions[k].first};
        m.build_one_thread_s = build(scene.mesh, kDecompositions[k].second, 1, index);
        m.build_s = build(scene.mesh, kDecompositions[k].second, 0, index);
        m.bytes_per_triangle = static_cast<double>(index->statistics().memory_bytes) /
                               static_cast<double>(scene.mesh->triangles.size());
        measure_queries(*index, requests, bodies, m, answers[k]);
        rounds[k].push_back(m);
      }
    }
    for (std::size_t k = 0; k < kDecompositions.size(); ++k) {
      measured_.push_back(medians(rounds[k]));
    }
    return agree(answers, scene.name);
  }

  [[nodiscard]] const std::vector<Measured>& measured() const { return measured_; }

 private:
  static bool agree(const std::array<Answers, kDecompositions.size()>& answers,
                    const std::string& scene) {
    for (const Answers& other : answers) {
      const bool same = other.nearest_sum_m == answers[0].nearest_sum_m &&
                        other.within == answers[0].within &&
                        other.intersecting == answers[0].intersecting &&
                        other.colliding_paths == answers[0].colliding_paths;
      if (same) continue;
      fmt::print(stderr,
                 "bench_decompositions: {}: decompositions answer differently: nearest {} and {}, "
                 "within {} and {}, intersecting {} and {}, colliding paths {} and {}\n",
                 scene, answers[0].nearest_sum_m, other.nearest_sum_m, answers[0].within,
                 other.within, answers[0].intersecting, other.intersecting,
                 answers[0].colliding_paths, other.colliding_paths);
      return false;
    }
    return true;
  }

  int rounds_;
  std::vector<Measured> measured_;
};

int run(const Options& options) {
  std::vector<NamedScene> scenes;
  for (const std::string& file : options.scenes) {
    scenes.push_back({std::filesystem::path(file).stem().string(), load_mesh(file, options.scale)});
  }
  if (scenes.empty()) scenes = default_scenes();
  Comparison comparison(options.rounds);
  bool agreed = true;
  for (const NamedScene& scene : scenes) agreed = comparison.add(scene) && agreed;
  fmt::print("\nmedians of {} rounds; queries with the near quadrilateral at 2000 poses\n\n",
             options.rounds);
  print_table(columns(), comparison.measured());
  json document = document_of("decompositions");
  document["scenes"] = to_json(columns(), comparison.measured());
  const int written = finish(document, options.json_file);
  return agreed ? written : 1;
}

}  // namespace
}  // namespace camway::bench

int main(int argc, char** argv) {
  CLI::App app{"Octree, k-d tree and bounding volumes: build time, memory, query time"};
  camway::bench::Options options;
  app.add_option("--scene", options.scenes, "scenes, instead of five of different kinds");
  app.add_option("--scale", options.scale, "multiplies coordinates")->capture_default_str();
  camway::bench::add_rounds_option(app, options.rounds);
  camway::bench::add_json_option(app, options.json_file);
  CLI11_PARSE(app, argc, argv);
  return camway::bench::run(options);
}
