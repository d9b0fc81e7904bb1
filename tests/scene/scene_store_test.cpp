// SPDX-License-Identifier: MIT
#include "daemon/scene/scene_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "daemon/scene/occupancy_mirror.h"
#include "daemon/scene/shape_mesh.h"

namespace camway::scene {
namespace {

using testing::HasSubstr;

std::shared_ptr<const Snapshot> revision_of(std::string name, std::uint64_t revision) {
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->name = std::move(name);
  snapshot->revision = revision;
  return snapshot;
}

TEST(SceneStore, FindsTheNewestSnapshotOfAName) {
  SceneStore store;
  EXPECT_EQ(store.find("room"), nullptr);
  store.put(revision_of("room", 1));
  const std::shared_ptr<const Snapshot> taken = store.find("room");
  store.put(revision_of("room", 2));
  EXPECT_EQ(store.find("room")->revision, 2U);
  EXPECT_EQ(taken->revision, 1U) << "what was taken stays as it is";
  EXPECT_EQ(store.find("Room"), nullptr);
  EXPECT_EQ(store.find(""), nullptr);
}

TEST(SceneStore, ListsInOrderOfName) {
  SceneStore store;
  EXPECT_EQ(store.summary(), "there are no scenes");
  for (const char* name : {"c", "a", "b"}) store.put(revision_of(name, 1));
  std::string names;
  for (const auto& snapshot : store.list()) names += snapshot->name;
  EXPECT_EQ(names, "abc");
  EXPECT_EQ(store.summary(), "there are: 'a' 'b' 'c'");
  for (const char* name : {"d", "e", "f", "g"}) store.put(revision_of(name, 1));
  EXPECT_EQ(store.summary(), "there are: 'a' 'b' 'c' 'd' 'e' and 2 more");
}

SceneChange put_box(const std::string& object) {
  Mesh mesh = *box_mesh(geometry::Vec3(1, 1, 1)).mesh;
  const ImportReport report = report_of(mesh, "box");
  return {SceneChange::Kind::kPut,
          object,
          make_source(ObjectKind::kBox, std::move(mesh), report, {}),
          {}};
}

TEST(SceneStore, ChangesASceneRevisionByRevision) {
  SceneStore store;
  EXPECT_EQ(store.change("room", put_box("a")).fault, StoreFault::kUnknownScene);
  EXPECT_THAT(store.change("room", put_box("a")).error, HasSubstr("'room'"));
  store.put(revision_of("room", 1));
  EXPECT_EQ(store.change("room", put_box("a")).snapshot->revision, 2U);
  const StoreResult refused = store.change("room", {SceneChange::Kind::kRemove, "b", nullptr, {}});
  EXPECT_EQ(refused.fault, StoreFault::kInvalid);
  EXPECT_THAT(refused.error, HasSubstr("'b'"));
  EXPECT_EQ(store.find("room")->revision, 2U) << "what is refused changes nothing";
  const std::optional<SceneHistory> history = store.history("room");
  ASSERT_TRUE(history);
  EXPECT_EQ(history->rebuild(2)->digest, store.find("room")->digest);
  EXPECT_TRUE(history->rebuild(1)->objects.empty());
  EXPECT_FALSE(store.history("attic"));
}

TEST(SceneStore, NeverTakesARevisionTwice) {
  SceneStore store;
  store.put(revision_of("room", 1));
  ASSERT_TRUE(store.change("room", put_box("a")).snapshot);
  EXPECT_EQ(store.put(revision_of("room", 1)).snapshot->revision, 3U);
  EXPECT_TRUE(store.remove("room"));
  EXPECT_FALSE(store.remove("room"));
  EXPECT_EQ(store.find("room"), nullptr);
  EXPECT_EQ(store.put(revision_of("room", 1)).snapshot->revision, 4U);
}

TEST(SceneStore, HoldsNoMoreThanItsLimits) {
  SceneStore store({.scenes = 2, .objects = 2, .triangles = 36, .history = {}});
  store.put(revision_of("room", 1));
  store.put(revision_of("attic", 1));
  const StoreResult third = store.put(revision_of("cellar", 1));
  EXPECT_EQ(third.fault, StoreFault::kLimit);
  EXPECT_THAT(third.error, HasSubstr("'cellar'"));
  EXPECT_TRUE(store.put(revision_of("attic", 2)).snapshot) << "replacing one is no third";
  EXPECT_TRUE(store.change("room", put_box("a")).snapshot);
  EXPECT_TRUE(store.change("room", put_box("b")).snapshot);
  EXPECT_THAT(store.change("room", put_box("c")).error, HasSubstr("2 objects"));
  EXPECT_TRUE(store.change("attic", put_box("a")).snapshot);
  EXPECT_THAT(store.change("attic", put_box("b")).error, HasSubstr("36 triangles"));
  EXPECT_EQ(store.find("attic")->objects.size(), 1U);
}

TEST(SceneStore, KeepsNoMoreHistoryOfAllScenesThanItsLimit) {
  const std::uint64_t of_a_box = put_box("a").source->memory_bytes();
  SceneStoreLimits limits;
  limits.history.bytes = 7 * of_a_box;
  SceneStore store(limits);
  for (int i = 0; i < 5; ++i) store.put(revision_of("room" + std::to_string(i), 1));
  const auto kept = [&] {
    std::uint64_t bytes = 0;
    for (int i = 0; i < 5; ++i) bytes += store.history("room" + std::to_string(i))->bytes();
    return bytes;
  };
  for (int round = 0; round < 20; ++round) {
    for (int i = 0; i < 5; ++i) {
      // What was put and taken out again is kept for the revisions between, and counts.
      ASSERT_TRUE(store.change("room" + std::to_string(i), put_box("a")).snapshot);
      ASSERT_LE(kept(), limits.history.bytes);
      ASSERT_TRUE(
          store.change("room" + std::to_string(i), {SceneChange::Kind::kRemove, "a", nullptr, {}})
              .snapshot);
      ASSERT_LE(kept(), limits.history.bytes);
    }
  }
  EXPECT_GE(kept(), 4 * of_a_box) << "and not much less";
  EXPECT_FALSE(store.history("room4")->entries().empty()) << "the newest is there";
}

TEST(SceneStore, HoldsNoMoreBytesOfOccupancyThanItsLimit) {
  const auto with_map = [](const std::string& name) {
    SnapshotOptions options;
    options.occupancy_resolution_m = 0.1;
    return make_snapshot(name, *box_mesh({1, 1, 1}).mesh, options).snapshot;
  };
  const std::uint64_t of_one = with_map("room")->occupancy->statistics().memory_bytes;
  ASSERT_GT(of_one, 0U);
  SceneStoreLimits limits;
  limits.occupancy_bytes = 2 * of_one;
  SceneStore store(limits);
  EXPECT_TRUE(store.put(with_map("room")).snapshot);
  EXPECT_TRUE(store.put(with_map("hall")).snapshot);
  const StoreResult third = store.put(with_map("attic"));
  EXPECT_EQ(third.fault, StoreFault::kLimit);
  EXPECT_THAT(third.error, HasSubstr("occupancy maps"));
}

TEST(SceneStore, MayBeReadWhileItChanges) {
  SceneStore store;
  store.put(revision_of("room", 0));
  constexpr std::uint64_t kLast = 2000;
  std::thread writer([&] {
    for (std::uint64_t revision = 1; revision <= kLast; ++revision) {
      store.put(revision_of("room", revision));
    }
  });
  std::uint64_t seen = 0;
  while (seen < kLast) {
    const std::uint64_t revision = store.find("room")->revision;
    ASSERT_GE(revision, seen) << "revisions never go back";
    seen = revision;
  }
  writer.join();
}

}  // namespace
}  // namespace camway::scene
