// SPDX-License-Identifier: MIT
//
// Cost of watching many paths while an object moves through their scene.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <ctime>
#include <memory>
#include <mutex>
#include <random>
#include <thread>

#include "daemon/motion/spline/interpolate.h"
#include "daemon/planning/stages/path_check.h"
#include "daemon/planning/watched_path.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "daemon/service/watches/watch_checker.h"
#include "tests/bench/columns.h"
#include "tests/bench/command_line.h"
#include "tests/support/random.h"

namespace camway::bench {
namespace {

using geometry::Quat;
using geometry::Vec3;
using nlohmann::json;
using planning::WatchedPath;
using scene::SceneChange;
using service::WatchChecker;

struct Options {
  std::string scene = own_scenes() + "/office.obj";
  std::size_t paths = 10'000;
  double keyframe_step_m = 2.0;
  double side_m = 0.5;
  double rate_hz = 10.0;
  int rounds = 200;
  std::string json_file;
};

/// A series of changes of one kind.
struct Watching {
  std::string change;
  std::size_t paths = 0;
  double rate_hz = 0.0;
  double broken = 0.0;      ///< paths that collide after a change, on average
  double core_share = 0.0;  ///< processor use of the checker's thread, in cores
  double median_s = 0.0;    ///< from the change to the last verdict about it
  double p99_s = 0.0;
};

double process_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

scene::Placement at(const Vec3& position) {
  std::string fault;
  return scene::Placement::make(position, Quat::Identity(), fault);
}

/// Returns paths free of the scene, with three keyframes some metres apart.
std::vector<std::shared_ptr<const WatchedPath>> free_paths(const scene::Snapshot& scene,
                                                           const Options& options) {
  testing::Random random(2006);
  const geometry::Box& bounds = scene.index.bounds();
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::normal_distribution<double> normal;
  const motion::Body body{motion::Camera{}};
  const collision::DetectOptions detect = planning::detect_options({});
  std::vector<motion::Keyframe> keyframes(3);
  std::vector<std::shared_ptr<const WatchedPath>> paths;
  while (paths.size() < options.paths) {
    Vec3 eye = bounds.min() +
               Vec3(share(random), share(random), share(random)).cwiseProduct(bounds.sizes());
    double time_s = 0.0;
    for (motion::Keyframe& keyframe : keyframes) {
      keyframe.time_s = time_s++;
      keyframe.pose = {
          eye, Quat(normal(random), normal(random), normal(random), normal(random)).normalized()};
      eye += 0.5 * options.keyframe_step_m *
             Vec3(normal(random), 0.1 * normal(random), normal(random));
    }
    const WatchedPath path(motion::interpolate(keyframes), body, detect);
    if (path.collisions(collision::Obstacles(scene), base::Deadline::never()).empty()) {
      paths.push_back(std::make_shared<const WatchedPath>(path));
    }
  }
  return paths;
}

/// Waits for verdicts on paths.
class Told {
 public:
  WatchChecker::Report take() {
    return [this](const WatchChecker::News& news) {
      const std::lock_guard lock(mutex_);
      verdicts_ += news.verdicts.size();
      for (const auto& verdict : news.verdicts) broken_ += verdict.collisions.empty() ? 0U : 1U;
      if (news.is_last) revision_ = news.revision;
      changed_.notify_all();
    };
  }
  void wait_for_verdicts(std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return verdicts_ >= count; });
  }
  void wait_for_revision(std::uint64_t revision) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return revision_ == revision; });
  }
  std::size_t broken() {
    const std::lock_guard lock(mutex_);
    return broken_;
  }

 private:
  std::mutex mutex_;  ///< guards all below
  std::condition_variable changed_;
  std::size_t verdicts_ = 0;
  std::size_t broken_ = 0;
  std::uint64_t revision_ = 0;
};

/// Moves the object at the given rate and times each change until all paths are judged.
Watching move_about(const Options& options, scene::SceneStore& store, Told& told,
                    const std::string& title) {
  using Clock = std::chrono::steady_clock;
  const geometry::Box bounds = store.find("bench")->index.bounds();
  const auto period = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(1.0 / options.rate_hz));
  testing::Random random(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<double> latencies_s;
  const std::size_t broken_before = told.broken();
  const double others_s = thread_seconds();
  const double all_s = process_seconds();
  const Stopwatch wall;
  Clock::time_point next = Clock::now();
  for (int round = 0; round < options.rounds; ++round) {
    // The object moves back and forth along the longer axis, at walking pace.
    const double phase = std::abs(std::fmod(0.15 * round / bounds.sizes().x(), 2.0) - 1.0);
    const Vec3 to(bounds.min().x() + phase * bounds.sizes().x(), bounds.center().y(),
                  bounds.min().z() + 0.37 * bounds.sizes().z());
    std::this_thread::sleep_until(next += period);
    const Stopwatch latency;
    const auto changed =
        store.change("bench", {SceneChange::Kind::kMove, "mover", nullptr, at(to)});
    told.wait_for_revision(changed.snapshot->revision);
    latencies_s.push_back(latency.seconds());
  }
  const double elapsed_s = wall.seconds();
  const double checker_s = (process_seconds() - all_s) - (thread_seconds() - others_s);
  return {title,
          options.paths,
          options.rate_hz,
          static_cast<double>(told.broken() - broken_before) / options.rounds,
          checker_s / elapsed_s,
          median(latencies_s),
          quantile(latencies_s, 0.99)};
}

SceneChange put(const std::string& name, double side_m, const Vec3& position) {
  scene::Mesh mesh = *scene::box_mesh(Vec3::Constant(side_m));
  const scene::ImportReport report = scene::report_of(mesh, "bench");
  return {SceneChange::Kind::kPut, name,
          scene::make_source(scene::ObjectKind::kBox, std::move(mesh), report, {}), at(position)};
}

int run(const Options& options) {
  scene::SceneStore store;
  store.put(scene::make_snapshot("bench", *load_mesh(options.scene, 1.0)).snapshot);
  const auto first = store.find("bench");
  const auto paths = free_paths(*first, options);
  std::vector<Watching> all;
  for (const double side_m : {options.side_m, 4.0 * options.side_m}) {
    Told told;
    WatchChecker checker(store, told.take());
    store.change("bench", put("mover", side_m, first->index.bounds().max() + Vec3::Constant(9.0)));
    const auto now = store.find("bench");
    for (std::size_t i = 0; i < paths.size(); ++i) checker.watch(i, "bench", paths[i], now);
    told.wait_for_verdicts(paths.size());
    all.push_back(move_about(options, store, told, fmt::format("a box of {:g} m moves", side_m)));
  }
  using W = Watching;
  const std::vector<Column<W>> columns{
      {"/change", "change", field(&W::change)},
      {"/paths", "paths", field(&W::paths)},
      {"/rate_hz", "changes/s", field(&W::rate_hz), as_number},
      {"/broken", "colliding after each", field(&W::broken), as_tenths},
      {"/core_share", "cores", field(&W::core_share), as_number},
      {"/median_s", "change to verdict", field(&W::median_s), as_duration},
      {"/p99_s", "p99", field(&W::p99_s), as_duration},
  };
  print_table(columns, all);
  json document = document_of("watch");
  document["changes"] = to_json(columns, all);
  return finish(document, options.json_file);
}

}  // namespace
}  // namespace camway::bench

int main(int argc, char** argv) {
  CLI::App app{"What watching many paths costs while an object moves through their scene"};
  camway::bench::Options options;
  app.add_option("--scene", options.scene, "A file");
  app.add_option("--paths", options.paths, "How many are watched")->capture_default_str();
  app.add_option("--step", options.keyframe_step_m, "Between keyframes, metres")
      ->capture_default_str();
  app.add_option("--side", options.side_m, "Of the box that moves, metres")->capture_default_str();
  app.add_option("--rate", options.rate_hz, "Changes a second")->capture_default_str();
  camway::bench::add_rounds_option(app, options.rounds);
  camway::bench::add_json_option(app, options.json_file);
  CLI11_PARSE(app, argc, argv);
  return camway::bench::run(options);
}
