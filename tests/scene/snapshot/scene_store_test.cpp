// SPDX-License-Identifier: MIT
#include "daemon/scene/snapshot/scene_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <latch>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/scene/mirror/scene_mirror.h"
#include "daemon/scene/snapshot/shape_mesh.h"

namespace camway::scene {
namespace {

using ::testing::HasSubstr;

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
  Mesh mesh = *box_mesh(geometry::Vec3(1, 1, 1));
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

TEST(SceneStore, WhatIsCalledOffChangesNothing) {
  SceneStore store;
  store.put(revision_of("room", 1));
  store.change("room", put_box("a"));
  const std::shared_ptr<const Snapshot> before = store.find("room");
  const ChangeTicket off;
  ASSERT_TRUE(off.cancel());
  for (const StoreResult& result :
       {store.change("room", put_box("b"), {}, off), store.restore("room", 1, {}, off),
        store.restore_as("room", 2, "hall", {}, off), store.put(revision_of("room", 9), {}, off),
        store.put(revision_of("hall", 1), {}, off)}) {
    EXPECT_EQ(result.snapshot, nullptr);
    EXPECT_EQ(result.fault, StoreFault::kCancelled);
    EXPECT_THAT(result.error, HasSubstr("cancelled"));
  }
  EXPECT_EQ(store.remove("room", off).fault, StoreFault::kCancelled);
  EXPECT_EQ(store.find("room"), before);
  EXPECT_EQ(store.kept("room").revisions.size(), 2U);
  EXPECT_EQ(store.find("hall"), nullptr);
}

TEST(SceneStore, AChangeIsCalledOffOrInForceAndNeverBoth) {
  SceneStore store;
  store.put(revision_of("room", 1));
  std::uint64_t expected = 1;
  for (int run = 0; run < 200; ++run) {
    const ChangeTicket ticket;
    bool is_cancelled = false;
    std::jthread other([&] {
      if (run % 2 == 0) std::this_thread::yield();
      is_cancelled = ticket.cancel();
    });
    const StoreResult result = store.change("room", put_box("a"), {}, ticket);
    other.join();
    ASSERT_NE(result.snapshot != nullptr, is_cancelled);
    expected += is_cancelled ? 0 : 1;
    ASSERT_EQ(store.find("room")->revision, expected);
    ASSERT_EQ(store.kept("room").revisions.size(), expected);
  }
}

TEST(SceneStore, RestoresARevisionAndSaysWhichAreKept) {
  SceneStore store({.history = {.changes = 3}});
  store.put(revision_of("room", 1), {.operation = "load"});
  std::vector<std::string> digests{"", store.find("room")->digest};
  for (const char* const object : {"a", "b", "c", "d"}) {
    const StoreResult next =
        store.change("room", put_box(object), {"put", object, "tester", 0, {}});
    digests.push_back(next.snapshot->digest);
  }
  const auto before = std::chrono::system_clock::now();
  const StoreResult restored = store.restore("room", 3, {.operation = "restore"});
  ASSERT_TRUE(restored.snapshot) << restored.error;
  EXPECT_EQ(restored.snapshot->revision, 6U);
  EXPECT_EQ(restored.snapshot->digest, digests[3]);
  EXPECT_EQ(restored.snapshot->find("a"), store.find("room")->find("a")) << "shared";
  EXPECT_EQ(store.restore("room", 5).snapshot->digest, digests[5]) << "nothing is lost by it";

  const SceneStore::Kept kept = store.kept("room");
  ASSERT_EQ(kept.revisions.size(), 4U);
  EXPECT_EQ(kept.newest->revision, 7U);
  EXPECT_EQ(kept.revisions[0].revision, 4U);
  EXPECT_EQ(kept.revisions[0].note.object, "c");
  EXPECT_EQ(kept.revisions[1].note.client, "tester");
  EXPECT_EQ(kept.revisions[2].note.restored_revision, 3U);
  EXPECT_GE(kept.revisions[2].note.when, before);
  EXPECT_LE(kept.revisions[2].note.when, std::chrono::system_clock::now());

  const StoreResult gone = store.restore("room", 3);
  EXPECT_EQ(gone.fault, StoreFault::kInvalid);
  EXPECT_THAT(gone.error, HasSubstr("3 of scene 'room' is not kept; 4 to 7 are"));
  EXPECT_EQ(store.restore("attic", 3).fault, StoreFault::kUnknownScene);
  EXPECT_EQ(store.kept("attic").newest, nullptr);
}

TEST(SceneStore, RestoresARevisionAsAnotherScene) {
  SceneStore store;
  store.put(revision_of("room", 1));
  store.put(revision_of("copy", 8));
  const std::string digest = store.change("room", put_box("a")).snapshot->digest;
  ASSERT_TRUE(store.change("room", put_box("b")).snapshot);
  const StoreResult copy = store.restore_as("room", 2, "copy");
  ASSERT_TRUE(copy.snapshot) << copy.error;
  EXPECT_EQ(copy.snapshot->name, "copy");
  EXPECT_EQ(copy.snapshot->revision, 9U) << "it has the place of another";
  EXPECT_EQ(copy.snapshot->digest, digest);
  EXPECT_EQ(store.find("room")->revision, 3U);
  EXPECT_THAT(store.restore_as("room", 4, "copy").error, HasSubstr("1 to 3 are"));
  EXPECT_EQ(store.restore_as("attic", 4, "copy").fault, StoreFault::kUnknownScene);
  EXPECT_TRUE(store.change("copy", put_box("c")).snapshot);
}

TEST(SceneStore, NeverTakesARevisionTwice) {
  SceneStore store;
  store.put(revision_of("room", 1));
  ASSERT_TRUE(store.change("room", put_box("a")).snapshot);
  EXPECT_EQ(store.put(revision_of("room", 1)).snapshot->revision, 3U);
  EXPECT_TRUE(store.remove("room").snapshot);
  EXPECT_EQ(store.remove("room").fault, StoreFault::kUnknownScene);
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
      // An object that was put and removed is kept for the revisions between, and counts.
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
    return make_snapshot(name, *box_mesh({1, 1, 1}), options).snapshot;
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

/// Runs `work(i)` on this many threads at a time.
void side_by_side(int threads, const std::function<void(int)>& work) {
  std::latch begin(threads);
  std::vector<std::jthread> running;
  for (int i = 0; i < threads; ++i) {
    running.emplace_back([&, i] {
      begin.arrive_and_wait();
      work(i);
    });
  }
}

TEST(SceneStore, ChangesSideBySideReachEveryLimitAndBreakNone) {
  constexpr int kThreads = 8;
  constexpr std::uint64_t kBoxes = 50;
  for (int round = 0; round < 20; ++round) {
    SceneStore store({.scenes = 30, .objects = 30, .triangles = 12 * kBoxes, .history = {}});
    store.put(revision_of("hall", 1));
    std::atomic<std::uint64_t> taken = 0;
    side_by_side(kThreads, [&](int i) {
      const std::string name = "room" + std::to_string(i);
      store.put(revision_of(name, 1));
      // In separate scenes, and in one common scene.
      for (int k = 0; k < 10; ++k) {
        for (const std::string& scene : {name, std::string("hall")}) {
          const std::string box = std::to_string(i) + "-" + std::to_string(k);
          const StoreResult result = store.change(scene, put_box(box));
          if (result.snapshot) ++taken;
          EXPECT_TRUE(result.snapshot || !result.error.empty());
        }
      }
      for (int k = 0; k < 10; ++k) store.put(revision_of(name + "-" + std::to_string(k), 1));
    });
    std::uint64_t triangles = 0;
    for (const auto& snapshot : store.list()) {
      triangles += snapshot->index.size();
      EXPECT_LE(snapshot->objects.size(), 30U);
    }
    EXPECT_EQ(store.list().size(), 30U);
    EXPECT_EQ(triangles, 12 * kBoxes);
    EXPECT_EQ(taken, kBoxes);
  }
}

TEST(SceneStore, OfOneSceneNoChangeIsLostAndNoRevisionTakenTwice) {
  SceneStore store;
  store.put(revision_of("room", 1));
  std::mutex mutex;
  std::set<std::uint64_t> revisions;
  side_by_side(8, [&](int i) {
    for (int k = 0; k < 25; ++k) {
      const StoreResult result =
          store.change("room", put_box(std::to_string(i) + "-" + std::to_string(k)));
      ASSERT_TRUE(result.snapshot) << result.error;
      const std::lock_guard lock(mutex);
      EXPECT_TRUE(revisions.insert(result.snapshot->revision).second);
    }
  });
  EXPECT_EQ(*revisions.rbegin(), 201U);
  EXPECT_EQ(store.find("room")->objects.size(), 200U);
  EXPECT_EQ(store.history("room")->rebuild(201)->digest, store.find("room")->digest);
}

TEST(SceneStore, AChangeOfOneSceneWaitsForNoneOfAnother) {
  SceneStore store;
  for (const char* name : {"room", "hall"}) store.put(revision_of(name, 1));
  std::latch is_changing(1);
  std::latch go_on(1);
  std::atomic<int> listening = 0;
  std::atomic<int> told = 0;
  store.on_change([&] {
    EXPECT_EQ(++listening, 1) << "never on two threads at a time";
    if (++told == 1) {
      is_changing.count_down();
      go_on.wait();
    }
    --listening;
  });
  std::jthread slow([&] { store.change("room", put_box("a")); });
  is_changing.wait();  // it is the turn of "room" until the listener comes back
  std::jthread quick([&] { store.change("hall", put_box("a")); });
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (store.find("hall")->revision == 1 && std::chrono::steady_clock::now() < patience) {
    std::this_thread::yield();
  }
  EXPECT_EQ(store.find("hall")->revision, 2U);
  EXPECT_EQ(store.list().size(), 2U);
  EXPECT_EQ(told, 1);
  go_on.count_down();
  slow.join();
  quick.join();
  EXPECT_EQ(told, 2);
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

/// A journal in which another process is always the first to change the scene, once.
class OutrunOnce : public SceneJournal {
 public:
  SceneStore* store = nullptr;
  SceneChange others;

  Keeping keep_scene(const Snapshot&, std::uint64_t, const ChangeNote&) override { return {}; }
  Keeping keep_changes(const Snapshot&, const Snapshot&, const SceneChanges&, const ChangeNote&,
                       std::uint64_t) override {
    if (std::exchange(is_outrun_, true)) return {};
    return {KeepFault::kOutrun, "another was first"};
  }
  Keeping keep_removal(const Snapshot&, const std::string&) override { return {}; }
  bool await_other(const std::string& scene, std::uint64_t revision) override {
    const auto read = [&](const Snapshot*) {
      return base::Result<SceneStore::OthersWork>(
          SceneStore::OthersChanges{{others}, {revision + 1, {}}});
    };
    return store->follow(scene, read).snapshot != nullptr;
  }
  bool catch_up() override { return true; }

 private:
  bool is_outrun_ = false;
};

TEST(SceneStore, AChangeThatDependsOnTheSceneIsMadeAgainOnWhatAnotherMadeFirst) {
  OutrunOnce journal;
  SceneStore store({}, &journal);
  journal.store = &store;
  journal.others = put_box("theirs");
  store.put(assemble("room", 1, {}, {}));
  int made = 0;
  const auto make = [&](const Snapshot& newest) {
    ++made;
    return MadeChange{put_box(newest.find("theirs") != nullptr ? "beside_theirs" : "alone")};
  };
  const StoreResult result = store.change("room", ChangeMaker(make));
  ASSERT_TRUE(result.snapshot) << result.error;
  EXPECT_EQ(made, 2);
  EXPECT_NE(result.snapshot->find("theirs"), nullptr);
  EXPECT_NE(result.snapshot->find("beside_theirs"), nullptr);
  EXPECT_EQ(result.snapshot->find("alone"), nullptr);
}

TEST(SceneStore, AChangeThatCannotBeMadeChangesNothing) {
  SceneStore store;
  store.put(assemble("room", 1, {}, {}));
  const auto make = [](const Snapshot&) { return MadeChange{{}, "no map", Limit::kNone}; };
  const StoreResult result = store.change("room", ChangeMaker(make));
  EXPECT_EQ(result.fault, StoreFault::kInvalid);
  EXPECT_EQ(result.error, "no map");
  EXPECT_EQ(store.find("room")->revision, 1U);
  EXPECT_EQ(store.change("cellar", ChangeMaker(make)).fault, StoreFault::kUnknownScene);
}

}  // namespace
}  // namespace camway::scene
