// SPDX-License-Identifier: MIT
//
// How building and certifying grow with the scene and with the path.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include <CLI/CLI.hpp>

#include "daemon/motion/interpolate.h"
#include "tests/bench/camway_side.h"
#include "tests/bench/measure.h"
#include "tests/bench/request_set.h"
#include "tests/bench/tiled_scene.h"

namespace camway::bench {
namespace {

using nlohmann::json;

struct Options {
  RequestSource source{own_scenes() + "/requests", "", 1.0};
  std::size_t largest = 10'000'000;
  std::size_t most_keyframes = 10'000;
  int rounds = 5;
  std::string json_file;
};

// One size of one series.
struct Point {
  std::string series;
  std::size_t size = 0;  // triangles or keyframes
  double build_s = -1.0;
  double field_build_s = -1.0;
  double bytes_per_triangle = 0.0;  // of the index
  double field_bytes = 0.0;
  double detect_s = 0.0;  // median over requests of medians over rounds
  double check_s = 0.0;
  std::size_t intervals = 0;
};

std::vector<BenchRequest> free_requests(const BenchScene& scene) {
  std::vector<BenchRequest> list;
  for (const BenchRequest& request : scene.requests) {
    if (request.difficulty == "free") list.push_back(request);
  }
  return list;
}

void measure_paths(const CamwayScene& scene, const std::vector<BenchRequest>& requests, int rounds,
                   Point& point) {
  std::vector<double> detect_s;
  std::vector<double> check_s;
  for (const BenchRequest& request : requests) {
    std::vector<double> detect_rounds_s;
    std::vector<double> check_rounds_s;
    std::size_t intervals = 0;
    for (int round = 0; round < rounds; ++round) {
      detect_rounds_s.push_back(warm_s([&] {
        intervals = testing::certified_intervals(scene.obstacles(), request.path, request.camera,
                                                 default_options())
                        .size();
      }));
      check_rounds_s.push_back(warm_s([&] {
        check_whole(scene.obstacles(), request.path, request.camera, default_options());
      }));
    }
    point.intervals += intervals;
    detect_s.push_back(median(detect_rounds_s));
    check_s.push_back(median(check_rounds_s));
  }
  point.detect_s = median(detect_s);
  point.check_s = median(check_s);
}

Point measure_scene(const std::string& series, const std::shared_ptr<const scene::Mesh>& mesh,
                    const std::vector<BenchRequest>& requests, int rounds) {
  Point point{.series = series, .size = mesh->triangles.size()};
  std::optional<CamwayScene> camway;
  std::vector<double> index_s;
  std::vector<double> field_s;
  const int builds = mesh->triangles.size() > 2'000'000 ? 1 : 3;
  for (int i = 0; i < builds; ++i) {
    camway.emplace(mesh);
    index_s.push_back(camway->index_build_s());
    field_s.push_back(camway->field_build_s());
  }
  point.build_s = median(index_s);
  point.field_build_s = median(field_s);
  point.bytes_per_triangle = static_cast<double>(camway->index().statistics().memory_bytes) /
                             static_cast<double>(mesh->triangles.size());
  point.field_bytes = static_cast<double>(camway->field_bytes());
  measure_paths(*camway, requests, rounds, point);
  return point;
}

// To and fro through the keyframes of a request, until there are `count`.
BenchRequest lengthened(const BenchRequest& request, std::size_t count) {
  const std::span<const motion::Segment> segments = request.path.segments();
  std::vector<motion::Pose> way;
  for (const motion::Segment& segment : segments) way.push_back(motion::pose_at(segment, 0.0));
  way.push_back(motion::pose_at(segments.back(), 1.0));
  std::vector<motion::Pose> poses;
  const std::size_t period = 2 * (way.size() - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = i % period;
    poses.push_back(way[at < way.size() ? at : period - at]);
  }
  const std::vector<double> times_s = motion::derive_times_s(poses);
  std::vector<motion::Keyframe> keyframes;
  for (std::size_t i = 0; i < count; ++i) keyframes.push_back({times_s[i], poses[i]});
  return {request.name, request.difficulty, request.camera, motion::interpolate(keyframes), count};
}

// Each size ten times the one before, up to `largest`.
std::vector<std::size_t> decades(std::size_t first, std::size_t largest) {
  std::vector<std::size_t> sizes;
  for (std::size_t size = first; size <= largest; size *= 10) sizes.push_back(size);
  return sizes;
}

std::vector<Point> scene_points(const BenchScene& base, const Options& options) {
  const std::vector<BenchRequest> requests = free_requests(base);
  const geometry::Vec3 center = requests.front().path.segments().front().position[0];
  std::vector<Point> points;
  for (const std::size_t size : decades(1000, options.largest)) {
    const bool smaller = size < base.mesh->triangles.size();
    points.push_back(measure_scene(
        "more space", smaller ? cropped(*base.mesh, center, size) : tiled(*base.mesh, size),
        requests, options.rounds));
  }
  for (std::size_t size = base.mesh->triangles.size(); size <= options.largest; size *= 4) {
    points.push_back(
        measure_scene("finer triangles", refined(*base.mesh, size), requests, options.rounds));
  }
  return points;
}

std::vector<Point> keyframe_points(const BenchScene& base, const Options& options) {
  const std::vector<BenchRequest> requests = free_requests(base);
  const BenchRequest& longest =
      *std::max_element(requests.begin(), requests.end(),
                        [](const auto& a, const auto& b) { return a.keyframes < b.keyframes; });
  const CamwayScene camway(base.mesh);
  std::vector<Point> points;
  for (const std::size_t count : decades(10, options.most_keyframes)) {
    Point point{.series = "keyframes", .size = count};
    measure_paths(camway, {lengthened(longest, count)}, options.rounds, point);
    points.push_back(point);
  }
  return points;
}

// How much longer detection takes on the largest scene of the series than on that of 10⁵ or so.
double growth(const std::vector<Point>& points, const std::string& series) {
  const Point* small = nullptr;
  const Point* large = nullptr;
  for (const Point& point : points) {
    if (point.series != series) continue;
    if (small == nullptr || point.size <= 200'000) small = &point;
    large = &point;
  }
  return small == nullptr ? 0.0 : large->detect_s / small->detect_s;
}

void print(const std::vector<Point>& points) {
  Table table({"series", "size", "index build", "field build", "index B/tri", "field MiB", "detect",
               "check", "intervals"});
  for (const Point& p : points) {
    table.add({p.series, std::to_string(p.size), duration_text(p.build_s),
               duration_text(p.field_build_s),
               p.build_s < 0.0 ? "-" : fmt::format("{:.1f}", p.bytes_per_triangle),
               fmt::format("{:.1f}", p.field_bytes / 0x1p20), duration_text(p.detect_s),
               duration_text(p.check_s), std::to_string(p.intervals)});
  }
  table.print();
}

int run(const Options& options) {
  // The scene with the most triangles that has free requests.
  std::vector<BenchScene> scenes = load_requests(options.source);
  std::sort(scenes.begin(), scenes.end(), [](const BenchScene& a, const BenchScene& b) {
    return a.mesh->triangles.size() > b.mesh->triangles.size();
  });
  const auto base = std::find_if(scenes.begin(), scenes.end(), [](const BenchScene& scene) {
    return !free_requests(scene).empty();
  });
  if (base == scenes.end()) {
    fmt::print(stderr, "bench_growth: no free requests in {}\n", options.source.requests);
    return 2;
  }
  fmt::print("{}: medians over its {} free requests and {} rounds\n\n", base->name,
             free_requests(*base).size(), options.rounds);
  std::vector<Point> points = scene_points(*base, options);
  const std::vector<Point> keyframes = keyframe_points(*base, options);
  points.insert(points.end(), keyframes.begin(), keyframes.end());
  print(points);
  const double space = growth(points, "more space");
  const double finer = growth(points, "finer triangles");
  fmt::print(
      "\ndetection on the largest scene against that of about 10^5 triangles: {} (more space), "
      "{} (finer triangles)\n",
      ratio_text(space), ratio_text(finer));

  json document{{"benchmark", "growth"},
                {"machine", machine()},
                {"base", base->name},
                {"rounds", options.rounds},
                {"detect_growth_more_space", space},
                {"detect_growth_finer_triangles", finer}};
  for (const Point& p : points) {
    json entry{{"series", p.series},
               {"size", p.size},
               {"detect_seconds", p.detect_s},
               {"check_seconds", p.check_s},
               {"intervals", p.intervals}};
    if (p.build_s >= 0.0) {
      entry["build_seconds"] = p.build_s;
      entry["field_build_seconds"] = p.field_build_s;
      entry["field_bytes"] = p.field_bytes;
      entry["bytes_per_triangle"] = p.bytes_per_triangle;
    }
    document["points"].push_back(entry);
  }
  const std::string error = write_json(options.json_file, document);
  if (!error.empty()) fmt::print(stderr, "bench_growth: {}\n", error);
  return error.empty() ? 0 : 1;
}

}  // namespace
}  // namespace camway::bench

int main(int argc, char** argv) {
  CLI::App app{"How building and certifying grow with triangles and keyframes"};
  camway::bench::Options options;
  app.add_option("--requests", options.source.requests, "folder of requests")
      ->capture_default_str();
  app.add_option("--scene", options.source.scene,
                 "scene of all requests, instead of the one named");
  app.add_option("--scale", options.source.scale, "multiplies the scene's coordinates")
      ->capture_default_str();
  app.add_option("--largest", options.largest, "triangles of the largest scene")
      ->capture_default_str();
  app.add_option("--most-keyframes", options.most_keyframes, "keyframes of the longest path")
      ->capture_default_str();
  app.add_option("--rounds", options.rounds, "repetitions")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--json", options.json_file, "write all numbers to this file");
  CLI11_PARSE(app, argc, argv);
  return camway::bench::run(options);
}
