// SPDX-License-Identifier: MIT
//
// Cost of durable changes, in turns with the same changes of a store that keeps nothing, and the
// time of a start that finds its scenes in the log.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stdexcept>

#include "daemon/scene/log/durable_scenes.h"
#include "daemon/scene/log/sqlite/sqlite_log.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "tests/bench/columns.h"
#include "tests/bench/command_line.h"
#include "tests/bench/scene_changes.h"
#include "tests/bench/tiled_scene.h"
#include "tests/support/temporary_folder.h"

namespace camway::bench {
namespace {

using nlohmann::json;
using scene::SceneChange;

struct Options {
  std::string scene = own_scenes() + "/office.obj";
  std::size_t triangles = 475'000;  ///< at least; a refinement makes four of one
  std::size_t objects = 1000;
  int rounds = 200;
  std::string json_file;
};

/// A series of changes.
struct Changes {
  std::string change;
  std::size_t objects = 0;
  std::size_t triangles = 0;
  double volatile_s = 0.0;  ///< median
  double durable_s = 0.0;   ///< median
  double durable_p99_s = 0.0;
  std::string ratio;
};

/// A store that keeps its scenes in a folder.
class DurableStore {
 public:
  explicit DurableStore(const std::filesystem::path& folder) {
    auto opened = scene::SqliteLog::open(folder, {});
    if (!opened) throw std::runtime_error(opened.error);
    log_ = *std::move(opened);
    journal_ = std::make_unique<scene::DurableScenes>(*log_);
    store_ = std::make_unique<scene::SceneStore>(scene::SceneStoreLimits{}, journal_.get());
    auto histories = journal_->load({});
    if (!histories) throw std::runtime_error(histories.error);
    for (scene::SceneHistory& history : *histories) expect_taken(store_->adopt(std::move(history)));
  }
  scene::SceneStore& store() { return *store_; }

 private:
  std::unique_ptr<scene::SqliteLog> log_;
  std::unique_ptr<scene::DurableScenes> journal_;
  std::unique_ptr<scene::SceneStore> store_;
};

/// Makes the same moves in both stores by turns.
Changes measure(scene::SceneStore& plain, scene::SceneStore& durable, const std::string& title,
                const std::string& object, int rounds) {
  std::vector<double> plain_s;
  std::vector<double> durable_s;
  for (int round = -5; round < rounds; ++round) {
    const SceneChange change = move(object, round);
    const double once_s = timed_s([&] { expect_taken(plain.change("bench", change)); });
    const double kept_s = timed_s([&] { expect_taken(durable.change("bench", change)); });
    if (round < 0) continue;
    plain_s.push_back(once_s);
    durable_s.push_back(kept_s);
  }
  const auto now = durable.find("bench");
  return {title,
          now->objects.size(),
          now->index.size(),
          median(plain_s),
          median(durable_s),
          quantile(durable_s, 0.99),
          fmt::format("{:.2f}", median(durable_s) / median(plain_s))};
}

void change_both(scene::SceneStore& a, scene::SceneStore& b, const SceneChange& change) {
  expect_taken(a.change("bench", change));
  expect_taken(b.change("bench", change));
}

Changes building(const Options& options) {
  const testing::TemporaryFolder folder;
  scene::SceneStore plain;
  DurableStore durable(folder.path());
  const auto mesh = refined(*load_mesh(options.scene, 1.0), options.triangles);
  const scene::SnapshotResult made = scene::make_snapshot("bench", *mesh);
  if (!made.snapshot) throw std::runtime_error(made.error);
  expect_taken(plain.put(made.snapshot));
  expect_taken(durable.store().put(made.snapshot));
  change_both(plain, durable.store(), put("ball", *scene::sphere_mesh(0.5, 1e-4), {}));
  const std::size_t moved = durable.store().find("bench")->find("ball")->triangles;
  return measure(plain, durable.store(), fmt::format("move of {} triangles", moved), "ball",
                 options.rounds);
}

/// Share by which a vertex of each ball is nearer to its centre than that of the one before.
constexpr double kDifference = 1e-6;

/// Also measures a start with all objects, in seconds.
Changes warehouse(const Options& options, double& start_s) {
  const testing::TemporaryFolder folder;
  Changes changes;
  {
    scene::SceneStore plain;
    DurableStore durable(folder.path());
    expect_taken(plain.put(scene::assemble("bench", 1, {}, {})));
    expect_taken(durable.store().put(scene::assemble("bench", 1, {}, {})));
    const scene::Mesh ball = *scene::sphere_mesh(0.5, 3.4e-3);
    for (std::size_t i = 0; i < options.objects; ++i) {
      const geometry::Vec3 at(2.0 * static_cast<double>(i % 32), 1.0,
                              2.0 * static_cast<double>(i / 32));
      // Each ball has another vertex, so that none shares its content.
      scene::Mesh own = ball;
      own.vertices[0] *= 1.0 - kDifference * static_cast<double>(i);
      change_both(plain, durable.store(), put(fmt::format("ball{:04}", i), std::move(own), at));
    }
    changes =
        measure(plain, durable.store(), "move of one of many balls", "ball0500", options.rounds);
  }
  start_s = timed_s([&] { DurableStore next(folder.path()); });
  return changes;
}

Changes small(const Options& options) {
  const testing::TemporaryFolder folder;
  scene::SceneStore plain;
  DurableStore durable(folder.path());
  expect_taken(plain.put(scene::assemble("bench", 1, {}, {})));
  expect_taken(durable.store().put(scene::assemble("bench", 1, {}, {})));
  change_both(plain, durable.store(), put("box", *scene::box_mesh({1, 1, 1}), {}));
  return measure(plain, durable.store(), "move of a box alone", "box", options.rounds);
}

int run(const Options& options) {
  double start_s = 0.0;
  std::vector<Changes> all{small(options), building(options), warehouse(options, start_s)};
  using C = Changes;
  const std::vector<Column<C>> columns{
      {"/change", "change", field(&C::change)},
      {"/objects", "objects", field(&C::objects)},
      {"/triangles", "triangles", field(&C::triangles)},
      {"/volatile_s", "volatile, median", field(&C::volatile_s), as_duration},
      {"/durable_s", "durable, median", field(&C::durable_s), as_duration},
      {"/durable_p99_s", "p99", field(&C::durable_p99_s), as_duration},
      {"/ratio", "ratio", field(&C::ratio)},
  };
  fmt::print("\n{} changes each, by turns\n\n", options.rounds);
  print_table(columns, all);
  fmt::print("\na start with the {} objects and {} triangles of the last row: {:.3g} s\n",
             all.back().objects, all.back().triangles, start_s);
  json document = document_of("durable");
  document["changes"] = to_json(columns, all);
  document["start_s"] = start_s;
  return finish(document, options.json_file);
}

}  // namespace
}  // namespace camway::bench

int main(int argc, char** argv) {
  CLI::App app{"What it costs to keep changes of scenes on the disk"};
  camway::bench::Options options;
  app.add_option("--scene", options.scene, "Its faces are divided for the scene of one large mesh");
  app.add_option("--triangles", options.triangles, "Of that mesh")->capture_default_str();
  app.add_option("--objects", options.objects, "Of the scene with many")->capture_default_str();
  camway::bench::add_rounds_option(app, options.rounds);
  camway::bench::add_json_option(app, options.json_file);
  CLI11_PARSE(app, argc, argv);
  return camway::bench::run(options);
}
