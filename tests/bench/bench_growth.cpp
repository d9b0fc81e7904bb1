// SPDX-License-Identifier: MIT
//
// Growth of the times of building and certifying with the sizes of scene and path.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "daemon/motion/spline/derive_times.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/bench/camway_side.h"
#include "tests/bench/columns.h"
#include "tests/bench/command_line.h"
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

// Time of a structure that was not built.
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// One size in one series.
struct Point {
  std::string series;
  std::size_t size = 0;  // triangles or keyframes
  double build_s = kUnknown;
  double field_build_s = kUnknown;
  double bytes_per_triangle = kUnknown;  // of the index
  double field_bytes = kUnknown;
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

// Returns a path back and forth through the keyframes of a request, with `count` keyframes.
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

// Returns sizes that grow by a factor of ten, up to `largest`.
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

// Returns the ratio of the times of detection on the largest scene and on one of about 10⁵
// triangles.
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

std::vector<Column<Point>> point_columns() {
  using P = Point;
  return {
      {"/series", "series", field(&P::series)},
      {"/size", "size", field(&P::size)},
      {"/build_seconds", "index build", field(&P::build_s), as_duration},
      {"/field_build_seconds", "field build", field(&P::field_build_s), as_duration},
      {"/bytes_per_triangle", "index B/tri", field(&P::bytes_per_triangle), as_tenths},
      {"/field_bytes", "", field(&P::field_bytes)},
      {"", "field MiB", [](const P& p) -> json { return p.field_bytes / 0x1p20; }, as_tenths},
      {"/detect_seconds", "detect", field(&P::detect_s), as_duration},
      {"/check_seconds", "check", field(&P::check_s), as_duration},
      {"/intervals", "intervals", field(&P::intervals)},
  };
}

int run(const Options& options) {
  // The scene with the most triangles among those with free requests.
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
  print_table(point_columns(), points);
  const double space = growth(points, "more space");
  const double finer = growth(points, "finer triangles");
  fmt::print(
      "\ndetection on the largest scene against that of about 10^5 triangles: {} (more space), "
      "{} (finer triangles)\n",
      ratio_text(space), ratio_text(finer));

  json document = document_of("growth");
  document["base"] = base->name;
  document["rounds"] = options.rounds;
  document["detect_growth_more_space"] = space;
  document["detect_growth_finer_triangles"] = finer;
  document["points"] = to_json(point_columns(), points);
  return finish(document, options.json_file);
}

}  // namespace
}  // namespace camway::bench

int main(int argc, char** argv) {
  CLI::App app{"How building and certifying grow with triangles and keyframes"};
  camway::bench::Options options;
  camway::bench::add_request_options(app, options.source);
  app.add_option("--largest", options.largest, "triangles of the largest scene")
      ->capture_default_str();
  app.add_option("--most-keyframes", options.most_keyframes, "keyframes of the longest path")
      ->capture_default_str();
  camway::bench::add_rounds_option(app, options.rounds);
  camway::bench::add_json_option(app, options.json_file);
  CLI11_PARSE(app, argc, argv);
  return camway::bench::run(options);
}
