// SPDX-License-Identifier: MIT
#include "daemon/scene/scene_store.h"

#include <gtest/gtest.h>

#include <thread>

namespace camway::scene {
namespace {

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

TEST(SceneStore, RemovesAndSaysWhetherThereWasAny) {
  SceneStore store;
  store.put(revision_of("room", 1));
  const std::shared_ptr<const Snapshot> taken = store.find("room");
  EXPECT_TRUE(store.remove("room"));
  EXPECT_EQ(store.find("room"), nullptr);
  EXPECT_EQ(taken->name, "room") << "what was taken stays as it is";
  EXPECT_FALSE(store.remove("room"));
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
