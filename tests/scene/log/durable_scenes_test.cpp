// SPDX-License-Identifier: MIT
//
// Stores that are made anew from the log of another one: the same scenes, bit for bit.
#include "daemon/scene/log/durable_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "daemon/scene/voxels/map_scan.h"
#include "tests/scene/log/memory_log.h"
#include "tests/scene/log/random_changes.h"
#include "tests/support/random.h"

namespace camway::scene {
namespace {

using geometry::Vec3;
using testing::change_at_random;
using ::testing::HasSubstr;
using testing::MemoryLog;
using testing::random_box;

/// A process with a store: ends, and begins again with the same log.
class Process {
 public:
  explicit Process(SceneLog& log, const SceneStoreLimits& limits = {})
      : journal_(log), store_(limits, &journal_) {
    auto histories = journal_.load(limits.history);
    error_ = histories.error;
    if (!histories) return;
    store_.begin_above(log.highest_removed());
    for (SceneHistory& history : *histories) {
      EXPECT_EQ(store_.adopt(std::move(history)).error, "");
    }
  }

  SceneStore& store() { return store_; }
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  DurableScenes journal_;
  SceneStore store_;
  std::string error_;
};

std::shared_ptr<const VoxelMap> empty_map() {
  VoxelSet occupied;
  occupied.insert(Voxel{0, 0, 0});
  return VoxelMap::build(0.1, std::move(occupied), {}, UnknownSpace::kFree).map;
}

/// Describes a store as users see it: every scene with all that its history can restore.
std::string description_of(const SceneStore& store) {
  std::string text;
  for (const auto& snapshot : store.list()) {
    text += snapshot->name + " " + std::to_string(snapshot->revision) + " " + snapshot->digest;
    const SceneHistory history = *store.history(snapshot->name);
    for (const KeptRevision& kept : history.revisions()) {
      text += "\n  " + std::to_string(kept.revision) + " " + kept.note.operation + " " +
              kept.note.object + " " + kept.note.client + " " + kept.note.request + " " +
              std::to_string(kept.note.restored_revision) + " " +
              std::to_string(kept.note.when.time_since_epoch().count()) + " " +
              history.rebuild(kept.revision)->digest;
    }
    text += "\n";
  }
  return text;
}

TEST(DurableScenes, AreTheSameInTheNextProcess) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    testing::Random random(seed);
    MemoryLog log;
    // Few changes are remembered, so that histories forget while the log still has more.
    SceneStoreLimits limits;
    limits.history.changes = 20;
    auto process = std::make_unique<Process>(log, limits);
    for (int step = 0; step < 900; ++step) {
      change_at_random(process->store(), random, step);
      if (step % 50 != 49) continue;
      const std::string before = description_of(process->store());
      process.reset();
      process = std::make_unique<Process>(log, limits);
      ASSERT_EQ(process->error(), "");
      ASSERT_EQ(description_of(process->store()), before) << "seed " << seed << " step " << step;
    }
  }
}

TEST(DurableScenes, ReadLittleAfterManyChanges) {
  testing::Random random(4);
  MemoryLog log;
  SceneStoreLimits limits;
  limits.history.changes = 8;
  Process process(log, limits);
  process.store().put(assemble("room", 1, {}, {}));
  for (int i = 0; i < 2000; ++i) {
    ASSERT_TRUE(process.store()
                    .change("room", {SceneChange::Kind::kPut, "crate", random_box(random), {}})
                    .snapshot);
  }
  EXPECT_LE((*log.scenes())[0].entries.size(), 256U);
  EXPECT_LE(log.blobs(), 256U + 9U) << "what nothing needs is dropped";
}

TEST(DurableScenes, KeepScansAsDifferences) {
  testing::Random random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  MemoryLog log;
  Process process(log);
  SceneStore& store = process.store();
  ObjectOptions options;
  std::shared_ptr<const VoxelMap> map = empty_map();
  const auto source_of = [&] {
    return make_map_source(map, report_of(*map, "scan"), options, geometry::Vec3::Zero());
  };
  store.put(assemble("room", 1, {}, options));
  ASSERT_TRUE(store.change("room", {SceneChange::Kind::kPut, "map", source_of(), {}}).snapshot);
  std::uint64_t after_first = 0;
  for (int i = 0; i < 70; ++i) {
    // Each looks into another direction, so that the map grows and one scan changes little of it.
    const Vec3 toward(20.0 * std::cos(0.1 * i), 20.0 * std::sin(0.1 * i), 0.0);
    std::vector<Vec3> points;
    for (int k = 0; k < 20; ++k) {
      points.push_back(toward + 0.5 * Vec3(unit(random), unit(random), unit(random)));
    }
    map = scanned(*map, {Vec3(0.55, 0.0, 0.0), points}).map;
    ASSERT_TRUE(map);
    ASSERT_TRUE(store.change("room", {SceneChange::Kind::kPut, "map", source_of(), {}}).snapshot);
    if (i == 39) after_first = log.blob_bytes();
  }
  const std::uint64_t whole = log.blob_bytes() - after_first;
  EXPECT_LT(whole, 30 * store.find("room")->objects[0]->source->map_O->memory_bytes() / 4);
  Process next(log);
  ASSERT_EQ(next.error(), "");
  EXPECT_EQ(description_of(next.store()), description_of(store));
  const VoxelMap& found = *next.store().find("room")->objects[0]->source->map_O;
  map->occupied().for_each_block([&](const Voxel& low, const VoxelSet::Bits&) {
    const std::uint64_t key = BlockKey::of(low);
    const Beliefs* const expected = map->beliefs(key);
    const Beliefs* const kept = found.beliefs(key);
    ASSERT_EQ(expected == nullptr, kept == nullptr);
    if (kept != nullptr) {
      ASSERT_EQ(*kept, *expected);
    }
  });
}

TEST(DurableScenes, ARepeatedRequestChangesNothingInTheNextProcess) {
  testing::Random random(6);
  MemoryLog log;
  const SceneChange change{SceneChange::Kind::kPut, "crate", random_box(random), {}};
  const ChangeNote note{.operation = "put", .client = "robot", .request = "robot/7/abc"};
  std::uint64_t revision = 0;
  {
    Process process(log);
    process.store().put(assemble("room", 1, {}, {}), {.request = "robot/6/abc"});
    revision = process.store().change("room", change, note).snapshot->revision;
  }
  Process next(log);
  EXPECT_EQ(next.store().change("room", change, note).snapshot->revision, revision);
  ChangeNote other = note;
  other.request = "robot/8/abc";
  EXPECT_EQ(next.store().change("room", change, other).snapshot->revision, revision + 1);
  EXPECT_EQ(
      next.store().put(assemble("room", 1, {}, {}), {.request = "robot/8/abc"}).snapshot->revision,
      revision + 1);
}

TEST(DurableScenes, WhatCannotBeKeptIsNotMade) {
  testing::Random random(7);
  MemoryLog log;
  SceneStoreLimits limits;
  limits.triangles = 24;
  Process process(log, limits);
  SceneStore& store = process.store();
  store.put(assemble("room", 1, {}, {}));
  const SceneChange put{SceneChange::Kind::kPut, "crate", random_box(random), {}};
  log.fault = AppendFault::kFull;
  const StoreResult refused = store.change("room", put);
  EXPECT_EQ(refused.fault, StoreFault::kFull);
  EXPECT_THAT(refused.error, HasSubstr("no disk"));
  EXPECT_EQ(store.find("room")->revision, 1U);
  EXPECT_EQ(store.put(assemble("attic", 1, {}, {})).fault, StoreFault::kFull);
  EXPECT_FALSE(store.find("attic"));
  log.fault = AppendFault::kNone;
  // The refused changes do not count any more: two crates fit.
  EXPECT_EQ(store.change("room", put).error, "");
  SceneChange second = put;
  second.object = "second";
  EXPECT_EQ(store.change("room", second).error, "");
  second.object = "third";
  EXPECT_EQ(store.change("room", second).fault, StoreFault::kLimit);
}

TEST(DurableScenes, RefuseADamagedLogAndSayWhichScene) {
  testing::Random random(8);
  MemoryLog log;
  {
    Process process(log);
    process.store().put(assemble("room", 1, {}, {}));
    process.store().change("room", {SceneChange::Kind::kPut, "crate", random_box(random), {}});
  }
  const Bytes whole = log.record("room", 1);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    log.record("room", 1) = Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_THAT(Process(log).error(), HasSubstr("'room'")) << size;
  }
  log.record("room", 1) = log.record("room", 0);
  EXPECT_THAT(Process(log).error(), HasSubstr("another revision"));
}

TEST(DurableScenes, ChangeSideBySide) {
  MemoryLog log;
  Process process(log);
  std::vector<std::thread> threads;
  for (const std::string scene : {"a", "b", "c"}) {
    threads.emplace_back([&process, scene] {
      testing::Random random(static_cast<std::uint64_t>(scene.front() - 'a'));
      process.store().put(assemble(scene, 1, {}, {}));
      for (int i = 0; i < 300; ++i) {
        process.store().change(scene, {SceneChange::Kind::kPut, "crate", random_box(random), {}});
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  Process next(log);
  EXPECT_EQ(next.error(), "");
  EXPECT_EQ(description_of(next.store()), description_of(process.store()));
}

}  // namespace
}  // namespace camway::scene
