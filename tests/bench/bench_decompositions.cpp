// SPDX-License-Identifier: MIT
//
// Comparison of spatial decompositions. (The question of Ptacek & Johnstone 2006, section 6.)
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
#include "tests/bench/decompositions/decomposition.h"
#include "tests/bench/motion_samples.h"
#include "tests/bench/tiled_scene.h"
#include "tests/support/random.h"

namespace camway::bench {
namespace {

using nlohmann::json;

/// The distance within which most probes of a detection are decided.
constexpr double kWithin_m = 0.25;
/// The farthest that a corner moves between two samples of a sampled detection.
constexpr double kSampleStep_m = 0.01;
/// For a value that a decomposition does not have; shown as "-".
constexpr double kNotMeasured_s = -1.0;

struct Options {
  std::vector<std::string> scenes;
  double scale = 1.0;
  bool with_large = true;
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
  double nodes_within = 0.0;      ///< nodes that a query within 25 cm visits
  double triangles_within = 0.0;  ///< entries of leaves that it looks at
  double touches_s = 0.0;
  double sampled_s = 0.0;
  double certify_s = kNotMeasured_s;
};

// Random camera paths through the scene, free or colliding.
std::vector<BenchRequest> random_paths(const scene::Mesh& mesh, std::uint64_t seed) {
  constexpr int kPaths = 40;
  const geometry::Box box = mesh.bounds();
  std::vector<BenchRequest> requests;
  for (int i = 0; i < kPaths; ++i) {
    testing::Random random = testing::Random::of_case(seed, static_cast<std::uint64_t>(i));
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

Body body_at(const motion::Corners& corners_C, const motion::Pose& pose) {
  return collision::near_quad_triangles(motion::corners_W(corners_C, pose));
}

std::vector<Body> poses_on(const std::vector<BenchRequest>& requests) {
  constexpr int kPosesPerPath = 50;
  std::vector<Body> bodies;
  for (const BenchRequest& request : requests) {
    const motion::Corners corners_C = motion::near_corners_C(request.camera);
    const double begin_s = request.path.begin_s();
    const double duration_s = request.path.end_s() - begin_s;
    for (int i = 0; i < kPosesPerPath; ++i) {
      const double time_s = begin_s + (i + 0.5) / kPosesPerPath * duration_s;
      bodies.push_back(body_at(corners_C, request.path.pose(time_s)));
    }
  }
  return bodies;
}

// A scene, and the paths in it.
struct Case {
  std::string name;
  std::shared_ptr<const scene::Mesh> mesh;
  std::vector<BenchRequest> requests;
};

// The queries that the decompositions of a scene answer.
struct Questions {
  explicit Questions(const std::vector<BenchRequest>& all) : requests(all), bodies(poses_on(all)) {
    for (const BenchRequest& request : requests) {
      samples.push_back(motion_samples(request.path, request.camera, kSampleStep_m));
    }
  }

  const std::vector<BenchRequest>& requests;
  std::vector<Body> bodies;
  std::vector<std::vector<MotionSample>> samples;  // of each request
};

// The answers of one decomposition's queries, for comparison with the others.
struct Answers {
  double nearest_sum_m = 0.0;
  std::size_t within = 0;
  std::size_t touching = 0;
  std::size_t colliding_samples = 0;
  /// Number of paths with collisions. The intervals are not compared: whether a short free part in
  /// one is resolved depends on the triangle that the index meets first.
  std::optional<std::size_t> colliding_paths;

  bool operator==(const Answers&) const = default;
};

void measure_queries(const Decomposition& tree, const std::vector<Body>& bodies, Measured& m,
                     Answers& answers) {
  m.nearest_s = warm_s([&] {
    answers.nearest_sum_m = 0.0;
    for (const Body& body : bodies) {
      const auto nearest = tree.nearest(body, std::numeric_limits<double>::infinity());
      answers.nearest_sum_m += nearest ? nearest->distance_m : 0.0;
    }
  });
  m.within_s = warm_s([&] {
    answers.within = 0;
    for (const Body& body : bodies) answers.within += tree.any_within(body, kWithin_m) ? 1U : 0U;
  });
  m.touches_s = warm_s([&] {
    answers.touching = 0;
    for (const Body& body : bodies) answers.touching += tree.touches(body) ? 1U : 0U;
  });
  QueryCost cost;
  for (const Body& body : bodies) {
    const QueryCost of_one = tree.cost_within(body, kWithin_m);
    cost.nodes += of_one.nodes;
    cost.triangles += of_one.triangles;
  }
  const double queries = static_cast<double>(bodies.size());
  m.nearest_s /= queries;
  m.within_s /= queries;
  m.touches_s /= queries;
  m.nodes_within = static_cast<double>(cost.nodes) / queries;
  m.triangles_within = static_cast<double>(cost.triangles) / queries;
}

// Detection at samples with any decomposition, and certified detection with those that serve as the
// scene's index.
void measure_detection(const Decomposition& tree, const Questions& asked, Measured& m,
                       Answers& answers) {
  m.sampled_s = warm_s([&] {
    answers.colliding_samples = 0;
    for (std::size_t i = 0; i < asked.requests.size(); ++i) {
      const motion::Corners corners_C = motion::near_corners_C(asked.requests[i].camera);
      const auto collides = [&](const motion::Pose& pose) {
        return tree.touches(body_at(corners_C, pose));
      };
      answers.colliding_samples +=
          check_samples(asked.requests[i].path, asked.samples[i], collides).colliding;
    }
  });
  const double paths = static_cast<double>(asked.requests.size());
  m.sampled_s /= paths;
  if (tree.index() == nullptr) return;
  m.certify_s = warm_s([&] {
    std::size_t colliding = 0;
    for (const BenchRequest& request : asked.requests) {
      const bool free =
          testing::certified_intervals(collision::Obstacles(*tree.index()), request.path,
                                       request.camera, default_options())
              .empty();
      colliding += free ? 0U : 1U;
    }
    answers.colliding_paths = colliding;
  });
  m.certify_s /= paths;
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
          rounds.front().nodes_within,
          rounds.front().triangles_within,
          over(&Measured::touches_s),
          over(&Measured::sampled_s),
          over(&Measured::certify_s)};
}

// The project's own scenes with their requests, and large ones with random paths.
std::vector<Case> default_cases(bool with_large) {
  std::vector<Case> cases;
  for (BenchScene& own : load_requests({.requests = own_scenes() + "/requests", .scene = ""})) {
    cases.push_back({std::move(own.name), own.mesh, std::move(own.requests)});
  }
  if (!with_large) return cases;
  const auto office = load_mesh(own_scenes() + "/office.obj", 1.0);
  cases.push_back({"office, tiled", tiled(*office, 250'000), {}});
  cases.push_back({"terrain: one fine surface", terrain(250'000), {}});
  cases.push_back({"dust: small triangles everywhere", dust(250'000, 7), {}});
  return cases;
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
      {"/any_within_nodes", "nodes", field(&M::nodes_within), as_tenths},
      {"/any_within_triangles", "triangles", field(&M::triangles_within), as_tenths},
      {"/touches_seconds", "touches", field(&M::touches_s), as_duration},
      {"/sampled_seconds", "path at 1 cm", field(&M::sampled_s), as_duration},
      {"/certify_seconds", "certify a path", field(&M::certify_s), as_duration},
  };
}

class Comparison {
 public:
  explicit Comparison(int rounds) : rounds_(rounds) {}

  // Returns false if two decompositions gave different answers.
  bool add(const Case& c) {
    const Questions asked(c.requests);
    const std::span<const DecompositionKind> kinds = decomposition_kinds();
    std::vector<std::vector<Measured>> rounds(kinds.size());
    std::vector<Answers> answers(kinds.size());
    for (int round = 0; round < rounds_; ++round) {
      for (std::size_t k = 0; k < kinds.size(); ++k) {
        rounds[k].push_back(measure(c, kinds[k], asked, answers[k]));
      }
    }
    for (const std::vector<Measured>& of_kind : rounds) measured_.push_back(medians(of_kind));
    return agree(answers, c.name);
  }

  [[nodiscard]] const std::vector<Measured>& measured() const { return measured_; }

 private:
  static Measured measure(const Case& c, const DecompositionKind& kind, const Questions& asked,
                          Answers& answers) {
    const auto triangles = c.mesh->triangles.size();
    Measured m{.scene = c.name, .triangles = triangles, .decomposition = kind.name};
    std::unique_ptr<const Decomposition> tree;
    const double begin_s = thread_seconds();
    tree = kind.build(c.mesh, 1);
    m.build_one_thread_s = thread_seconds() - begin_s;
    tree.reset();
    m.build_s = timed_s([&] { tree = kind.build(c.mesh, 0); });
    m.bytes_per_triangle =
        static_cast<double>(tree->memory_bytes()) / static_cast<double>(triangles);
    measure_queries(*tree, asked.bodies, m, answers);
    measure_detection(*tree, asked, m, answers);
    return m;
  }

  static bool agree(std::vector<Answers> answers, const std::string& scene) {
    for (Answers& other : answers) {
      if (!other.colliding_paths) other.colliding_paths = answers[0].colliding_paths;
      if (other == answers[0]) continue;
      fmt::print(stderr,
                 "bench_decompositions: {}: decompositions answer differently: nearest {} and {}, "
                 "within {} and {}, touching {} and {}, colliding samples {} and {}, colliding "
                 "paths {} and {}\n",
                 scene, answers[0].nearest_sum_m, other.nearest_sum_m, answers[0].within,
                 other.within, answers[0].touching, other.touching, answers[0].colliding_samples,
                 other.colliding_samples, *answers[0].colliding_paths, *other.colliding_paths);
      return false;
    }
    return true;
  }

  int rounds_;
  std::vector<Measured> measured_;
};

int run(const Options& options) {
  std::vector<Case> cases;
  for (const std::string& file : options.scenes) {
    cases.push_back(
        {std::filesystem::path(file).stem().string(), load_mesh(file, options.scale), {}});
  }
  if (cases.empty()) cases = default_cases(options.with_large);
  Comparison comparison(options.rounds);
  bool agreed = true;
  for (Case& c : cases) {
    if (c.requests.empty()) c.requests = random_paths(*c.mesh, 3);
    agreed = comparison.add(c) && agreed;
  }
  fmt::print(
      "\nmedians of {} rounds; queries with the near quadrilateral at 50 poses of each path\n\n",
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
  CLI::App app{"Octree, k-d tree, box hierarchy and BSP tree: build time, memory, query time"};
  camway::bench::Options options;
  app.add_option("--scene", options.scenes,
                 "scenes, with random paths, instead of six of different kinds");
  app.add_flag("!--no-large", options.with_large, "leave out the three large scenes");
  app.add_option("--scale", options.scale, "multiplies coordinates")->capture_default_str();
  camway::bench::add_rounds_option(app, options.rounds);
  camway::bench::add_json_option(app, options.json_file);
  CLI11_PARSE(app, argc, argv);
  return camway::bench::run(options);
}
