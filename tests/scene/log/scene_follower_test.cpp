// SPDX-License-Identifier: MIT
//
// Several processes that change the same scenes by one log: the same scenes in all of them.
#include "daemon/scene/log/scene_follower.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/scene/log/random_changes.h"
#include "tests/scene/log/shared_memory_log.h"
#include "tests/support/random.h"

namespace camway::scene {
namespace {

using ::testing::HasSubstr;
using testing::SharedMemory;
using testing::SharedMemoryLog;

constexpr std::chrono::seconds kPatience{30};

/// A process of a fleet. It follows the log from `begin` on.
class Member {
 public:
  explicit Member(std::shared_ptr<SharedMemory> shared, const SceneStoreLimits& limits = {},
                  std::chrono::milliseconds patience = kPatience, bool has_mirrors = true)
      : log_(std::move(shared)),
        scenes_(log_, patience),
        store_(limits, has_mirrors ? &scenes_ : nullptr) {
    if (!has_mirrors) scenes_.leave_out_mirrors();
    auto histories = scenes_.load(limits.history);
    EXPECT_TRUE(histories) << histories.error;
    store_.begin_above(log_.highest_removed());
    store_.remember_removals(log_.removals());
    for (SceneHistory& history : *histories) store_.adopt(std::move(history));
  }

  void begin() {
    follower_.emplace(
        log_, scenes_, store_,
        [this](const std::string& warning) {
          const std::lock_guard lock(mutex_);
          warnings_.push_back(warning);
        },
        SceneFollower::Advanced(),
        [this](const Snapshot& scene, bool is_removed) {
          const std::lock_guard lock(mutex_);
          told_.push_back(scene.name + " " + std::to_string(scene.revision) +
                          (is_removed ? " removed" : ""));
        });
  }
  /// Waits until it has read all of the log.
  void catch_up(const SharedMemory& shared) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (log_.followed() < shared.position && std::chrono::steady_clock::now() < end) {
      std::this_thread::yield();
    }
    ASSERT_EQ(log_.followed(), shared.position);
  }

  SceneStore& store() { return store_; }
  std::vector<std::string> warnings() {
    const std::lock_guard lock(mutex_);
    return warnings_;
  }
  /// The changes of others that it was told of.
  std::vector<std::string> told() {
    const std::lock_guard lock(mutex_);
    return told_;
  }

 private:
  SharedMemoryLog log_;
  DurableScenes scenes_;
  SceneStore store_;
  std::mutex mutex_;  ///< guards the next two
  std::vector<std::string> warnings_;
  std::vector<std::string> told_;
  std::optional<SceneFollower> follower_;
};

/// Revisions and digests of all scenes. What histories keep may differ.
std::map<std::string, std::string> digests_of(const SceneStore& store) {
  std::map<std::string, std::string> digests;
  for (const auto& scene : store.list()) {
    digests[scene->name] = std::to_string(scene->revision) + " " + scene->digest;
  }
  return digests;
}

SceneChange put(const std::string& name, const std::shared_ptr<const ObjectSource>& source) {
  return {SceneChange::Kind::kPut, name, source, {}};
}

TEST(SceneFollower, BringsWhatOthersChange) {
  const auto shared = std::make_shared<SharedMemory>();
  Member front(shared);
  Member planner(shared);
  front.begin();
  planner.begin();
  testing::Random random(1);
  for (int step = 0; step < 1500; ++step) {
    testing::change_at_random(front.store(), random, step);
    if (step % 100 != 99) continue;
    planner.catch_up(*shared);
    ASSERT_EQ(digests_of(planner.store()), digests_of(front.store())) << "step " << step;
  }
  EXPECT_THAT(planner.warnings(), ::testing::IsEmpty());
}

TEST(SceneFollower, MakesEachChangeOfSeveralWritersOnce) {
  const auto shared = std::make_shared<SharedMemory>();
  std::vector<std::unique_ptr<Member>> members;
  for (int i = 0; i < 3; ++i) {
    members.push_back(std::make_unique<Member>(shared));
    members.back()->begin();
  }
  ASSERT_TRUE(members[0]->store().put(assemble("room", 1, {}, {})).snapshot);
  for (auto& member : members) member->catch_up(*shared);
  constexpr int kChanges = 120;
  {
    std::vector<std::jthread> writers;
    for (int writer = 0; writer < 4; ++writer) {
      // Two writers in each of two members; the third only follows.
      writers.emplace_back([&, writer] {
        testing::Random random(static_cast<unsigned>(writer));
        const auto source = testing::random_box(random);
        for (int i = 0; i < kChanges; ++i) {
          const std::string name = "w" + std::to_string(writer) + "c" + std::to_string(i);
          const StoreResult made = members[static_cast<std::size_t>(writer % 2)]->store().change(
              "room", put(name, source), {.request = name});
          EXPECT_EQ(made.error, "") << name;
        }
      });
    }
  }
  for (auto& member : members) {
    member->catch_up(*shared);
    const auto room = member->store().find("room");
    EXPECT_EQ(room->revision, 1U + 4 * kChanges);
    EXPECT_EQ(room->objects.size(), std::size_t{4} * kChanges);
    EXPECT_EQ(digests_of(member->store()), digests_of(members[0]->store()));
    EXPECT_THAT(member->warnings(), ::testing::IsEmpty());
  }
  Member late(shared);
  EXPECT_EQ(digests_of(late.store()), digests_of(members[0]->store()));
}

TEST(SceneFollower, MakesNoRequestTwiceThatTwoMembersGet) {
  const auto shared = std::make_shared<SharedMemory>();
  Member one(shared);
  Member two(shared);
  one.begin();
  two.begin();
  one.store().put(assemble("room", 1, {}, {}));
  two.catch_up(*shared);
  testing::Random random(3);
  const auto source = testing::random_box(random);
  for (int i = 0; i < 50; ++i) {
    const ChangeNote note{.request = "request " + std::to_string(i)};
    const std::jthread other([&] { two.store().change("room", put("crate", source), note); });
    one.store().change("room", put("crate", source), note);
  }
  one.catch_up(*shared);
  EXPECT_EQ(one.store().find("room")->revision, 51U);
}

TEST(SceneFollower, FindsASceneAfterItsEntriesWereReplaced) {
  const auto shared = std::make_shared<SharedMemory>();
  Member front(shared);
  Member slow(shared);
  front.begin();
  testing::Random random(4);
  front.store().put(assemble("room", 1, {}, {}));
  front.store().put(assemble("attic", 1, {}, {}));
  front.store().remove("attic");
  // Beyond two summaries of 256 entries.
  for (int i = 0; i < 600; ++i) {
    ASSERT_TRUE(front.store().change("room", put("crate", testing::random_box(random))).snapshot);
  }
  ASSERT_LT(shared->updates.size(), 300U);
  slow.begin();
  slow.catch_up(*shared);
  EXPECT_EQ(digests_of(slow.store()), digests_of(front.store()));
  EXPECT_THAT(slow.warnings(), ::testing::IsEmpty());
  // A new scene of that name begins above the removed one, whichever member makes it.
  const StoreResult again = slow.store().put(assemble("attic", 1, {}, {}));
  ASSERT_EQ(again.error, "");
  EXPECT_GT(again.snapshot->revision, 1U);
}

TEST(SceneFollower, CatchesUpWithOthers) {
  const auto shared = std::make_shared<SharedMemory>();
  Member one(shared);
  Member two(shared);
  one.begin();
  two.begin();
  testing::Random random(8);
  ASSERT_TRUE(one.store().put(assemble("room", 1, {}, {})).snapshot);
  for (int i = 0; i < 200; ++i) {
    const StoreResult made = one.store().change("room", put("crate", testing::random_box(random)));
    ASSERT_TRUE(two.store().catch_up());
    ASSERT_EQ(two.store().find("room")->revision, made.snapshot->revision);
  }
  SceneStore alone;
  EXPECT_FALSE(alone.catch_up());
}

TEST(SceneFollower, ARequestRemovesOneSceneWhicheverMemberGetsIt) {
  const auto shared = std::make_shared<SharedMemory>();
  Member one(shared);
  Member two(shared);
  one.begin();
  two.begin();
  for (int i = 0; i < 30; ++i) {
    const std::string request = "request " + std::to_string(i);
    ASSERT_TRUE(one.store().put(assemble("room", 1, {}, {})).snapshot);
    ASSERT_TRUE(two.store().catch_up());
    {
      const std::jthread other([&] { two.store().remove("room", {}, request); });
      one.store().remove("room", {}, request);
    }
    // A new scene of that name stays, whoever is asked again.
    ASSERT_TRUE(one.store().put(assemble("room", 1, {}, {})).snapshot);
    EXPECT_EQ(two.store().remove("room", {}, request).error, "");
    EXPECT_EQ(one.store().remove("room", {}, request).error, "");
    ASSERT_TRUE(two.store().catch_up());
    ASSERT_TRUE(one.store().catch_up());
    ASSERT_TRUE(one.store().find("room"));
    ASSERT_TRUE(two.store().find("room"));
    Member late(shared);
    EXPECT_TRUE(late.store().removed_by(request));
    ASSERT_TRUE(one.store().remove("room").snapshot);
  }
}

TEST(SceneFollower, TellsOfTheChangesOfOthersAlone) {
  const auto shared = std::make_shared<SharedMemory>();
  Member one(shared);
  Member two(shared);
  one.begin();
  two.begin();
  testing::Random random(9);
  ASSERT_TRUE(one.store().put(assemble("room", 1, {}, {})).snapshot);
  ASSERT_TRUE(two.store().catch_up());
  ASSERT_TRUE(two.store().change("room", put("crate", testing::random_box(random))).snapshot);
  ASSERT_TRUE(one.store().catch_up());
  ASSERT_TRUE(one.store().remove("room").snapshot);
  ASSERT_TRUE(two.store().catch_up());
  ASSERT_TRUE(one.store().catch_up());
  EXPECT_THAT(one.told(), ::testing::ElementsAre("room 2"));
  EXPECT_THAT(two.told(), ::testing::ElementsAre("room 1", "room 2 removed"));
}

TEST(SceneFollower, LeavesOutMirrorsAndHasTheSameDigests) {
  const auto shared = std::make_shared<SharedMemory>();
  Member front(shared);
  front.begin();
  testing::Random random(7);
  ObjectOptions options;
  options.occupancy_resolution_m = 0.1;
  front.store().put(assemble("room", 1, {}, options));
  front.store().change("room", put("crate", testing::random_box(random)));
  Member planner(shared, {}, kPatience, /*has_mirrors=*/false);
  planner.begin();
  front.store().put(assemble("attic", 1, {}, options));
  front.store().change("attic", put("crate", testing::random_box(random)));
  planner.catch_up(*shared);
  EXPECT_EQ(digests_of(planner.store()), digests_of(front.store()));
  for (const char* const name : {"room", "attic"}) {
    EXPECT_TRUE(front.store().find(name)->occupancy) << name;
    EXPECT_FALSE(planner.store().find(name)->occupancy) << name;
  }
}

TEST(SceneFollower, SaysWhatItCannotMakeAndStaysOnAnOlderRevision) {
  const auto shared = std::make_shared<SharedMemory>();
  Member front(shared);
  SceneStoreLimits limits;
  limits.objects = 2;
  Member small(shared, limits);
  front.begin();
  small.begin();
  testing::Random random(5);
  front.store().put(assemble("room", 1, {}, {}));
  for (const char* name : {"a", "b", "c", "d"}) {
    front.store().change("room", put(name, testing::random_box(random)));
  }
  small.catch_up(*shared);
  EXPECT_EQ(small.store().find("room")->revision, 3U);
  ASSERT_EQ(small.warnings().size(), 2U);
  EXPECT_THAT(small.warnings()[0], HasSubstr("revision 4 of scene 'room' cannot be made here"));
  EXPECT_THAT(small.warnings()[0], HasSubstr("more than 2 objects"));
}

TEST(SceneFollower, GivesUpAChangeThatWasOutrunIfTheOtherOneDoesNotArrive) {
  const auto shared = std::make_shared<SharedMemory>();
  Member front(shared);
  Member deaf(shared, {}, std::chrono::milliseconds(50));
  front.begin();
  testing::Random random(6);
  front.store().put(assemble("room", 1, {}, {}));
  const StoreResult refused = deaf.store().put(assemble("room", 1, {}, {}));
  EXPECT_EQ(refused.fault, StoreFault::kNotKept);
  EXPECT_EQ(deaf.store().find("room"), nullptr);
  deaf.begin();
  deaf.catch_up(*shared);
  EXPECT_EQ(deaf.store().put(assemble("room", 1, {}, {})).error, "");
}

}  // namespace
}  // namespace camway::scene
