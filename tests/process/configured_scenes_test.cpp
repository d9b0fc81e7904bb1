// SPDX-License-Identifier: MIT
#include "daemon/process/configured_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "tests/support/captured_log.h"
#include "tests/support/temporary_folder.h"

namespace camway::process {
namespace {

using testing::CapturedLog;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

constexpr char kTriangle[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
constexpr char kTwoTriangles[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n";

SceneArgument scene_of(const std::string& name, const std::string& file, double scale = 1.0) {
  SceneArgument scene;
  scene.name = name;
  scene.file = file;
  scene.options.import.scale = scale;
  return scene;
}

SceneArgument watched(SceneArgument scene) {
  scene.watch = true;
  return scene;
}

class ConfiguredScenesTest : public ::testing::Test {
 protected:
  std::uint64_t revision_of(const std::string& name) const {
    const auto snapshot = store_.find(name);
    return snapshot ? snapshot->revision : 0;
  }

  /// Returns how often the log has this text.
  int count_of(const std::string& text) const {
    const std::string log = log_.text();
    int count = 0;
    for (std::size_t at = log.find(text); at != std::string::npos; at = log.find(text, at + 1)) {
      ++count;
    }
    return count;
  }

  TemporaryFolder folder_;
  std::string room_ = folder_.write("room.obj", kTriangle);
  std::string hall_ = folder_.write("hall.obj", kTriangle);
  CapturedLog log_;
  scene::SceneStore store_;
  ConfiguredScenes scenes_{store_, log_.log()};
};

TEST_F(ConfiguredScenesTest, LoadsWhatIsNewAndLeavesTheRestAlone) {
  ASSERT_TRUE(scenes_.update({scene_of("room", room_)})) << log_.text();
  const auto room = store_.find("room");
  ASSERT_TRUE(scenes_.update({scene_of("room", room_), scene_of("hall", hall_)})) << log_.text();
  EXPECT_EQ(store_.find("room"), room) << "not read again";
  EXPECT_EQ(revision_of("hall"), 1U);
}

TEST_F(ConfiguredScenesTest, SaysWhetherASceneWasInTheCache) {
  const scene::SceneCache cache(folder_.path() / "cache", {.least_triangles = 1});
  for (const char* const from_cache : {"from_cache=no", "from_cache=yes"}) {
    scene::SceneStore store;
    ConfiguredScenes scenes(store, log_.log(), cache);
    EXPECT_TRUE(scenes.update({scene_of("room", room_)}));
    EXPECT_EQ(count_of(from_cache), 1) << log_.text();
    EXPECT_EQ(store.find("room")->index.size(), 1U);
  }
}

TEST_F(ConfiguredScenesTest, RemovesWhatItHeldItselfAndNothingElse) {
  auto other = std::make_shared<scene::Snapshot>();
  other->name = "uploaded";
  store_.put(other);
  ASSERT_TRUE(scenes_.update({scene_of("room", room_), scene_of("hall", hall_)}));
  ASSERT_TRUE(scenes_.update({scene_of("hall", hall_)}));
  EXPECT_EQ(store_.find("room"), nullptr);
  EXPECT_NE(store_.find("hall"), nullptr);
  EXPECT_NE(store_.find("uploaded"), nullptr);
  EXPECT_THAT(log_.text(), HasSubstr("info scene unloaded scene=room"));
}

TEST_F(ConfiguredScenesTest, ReadsAgainWhatIsToBeReadInAnotherWayOrChangedOnDisk) {
  ASSERT_TRUE(scenes_.update({scene_of("room", room_)}));
  const std::string before = store_.find("room")->digest;
  ASSERT_TRUE(scenes_.update({scene_of("room", room_, 2.0)}));
  EXPECT_EQ(revision_of("room"), 2U);
  EXPECT_NE(store_.find("room")->digest, before);

  const std::string scaled = store_.find("room")->digest;
  folder_.write("room.obj", kTwoTriangles);
  ASSERT_TRUE(scenes_.update({scene_of("room", room_, 2.0)}));
  EXPECT_EQ(revision_of("room"), 3U);
  EXPECT_NE(store_.find("room")->digest, scaled);
}

TEST_F(ConfiguredScenesTest, ChangesNothingIfOneSceneIsBad) {
  ASSERT_TRUE(scenes_.update({scene_of("room", room_)}));
  const std::string missing = (folder_.path() / "missing.obj").string();
  EXPECT_FALSE(scenes_.update({scene_of("hall", hall_), scene_of("attic", missing)}));
  EXPECT_NE(store_.find("room"), nullptr);
  EXPECT_EQ(store_.find("hall"), nullptr);
  EXPECT_THAT(log_.text(), HasSubstr("error scene cannot be read scene=attic "));
  EXPECT_THAT(log_.text(), HasSubstr("missing.obj"));
  // The next valid configuration continues from the scenes that are held.
  EXPECT_TRUE(scenes_.update({scene_of("hall", hall_)}));
  EXPECT_EQ(store_.find("room"), nullptr);
}

TEST_F(ConfiguredScenesTest, LeavesOutWhatTheStoreHasNoRoomFor) {
  scene::SceneStoreLimits limits;
  limits.scenes = 1;
  scene::SceneStore small(limits);
  ConfiguredScenes scenes(small, log_.log());
  EXPECT_FALSE(scenes.update({scene_of("room", room_), scene_of("hall", hall_)}));
  EXPECT_NE(small.find("room"), nullptr);
  EXPECT_EQ(small.find("hall"), nullptr);
  EXPECT_THAT(log_.text(), HasSubstr("there are 1 scenes already"));
  EXPECT_TRUE(scenes.update({scene_of("hall", hall_)})) << "what is gone makes room first";
  EXPECT_NE(small.find("hall"), nullptr);
}

TEST_F(ConfiguredScenesTest, GivesUpBetweenScenesWhenAskedToStop) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(scenes_.update({scene_of("room", room_)}, stop.get_token()));
  EXPECT_TRUE(store_.list().empty());
}

TEST_F(ConfiguredScenesTest, ReadsAWatchedFileAgainOnceItsWriterIsDone) {
  ASSERT_TRUE(scenes_.update({watched(scene_of("room", room_)), scene_of("hall", hall_)}));
  EXPECT_TRUE(scenes_.watches_files());
  const auto before = store_.find("room");
  scenes_.look_at_files();
  EXPECT_EQ(store_.find("room"), before);
  // At every check while it grows.
  for (std::size_t length = 10; length < sizeof(kTwoTriangles) - 1; length += 20) {
    folder_.write("room.obj", std::string(kTwoTriangles).substr(0, length));
    scenes_.look_at_files();
    EXPECT_EQ(store_.find("room"), before);
  }
  folder_.write("room.obj", kTwoTriangles);
  folder_.write("hall.obj", kTwoTriangles);
  scenes_.look_at_files();
  EXPECT_EQ(store_.find("room"), before);
  scenes_.look_at_files();
  EXPECT_EQ(store_.find("room")->index.size(), 2U);
  EXPECT_EQ(revision_of("room"), 2U);
  EXPECT_EQ(revision_of("hall"), 1U) << "nobody asked for that";
  scenes_.look_at_files();
  EXPECT_EQ(revision_of("room"), 2U);
}

TEST_F(ConfiguredScenesTest, SeesAFileThatIsReplacedByOneOfTheSameSizeAndTime) {
  ASSERT_TRUE(scenes_.update({watched(scene_of("room", room_))}));
  const auto time = std::filesystem::last_write_time(room_);
  std::string other = kTriangle;
  other[2] = '3';
  const std::string next = folder_.write("next.obj", other);
  std::filesystem::last_write_time(next, time);
  std::filesystem::rename(next, room_);
  scenes_.look_at_files();
  scenes_.look_at_files();
  EXPECT_EQ(revision_of("room"), 2U);
}

TEST_F(ConfiguredScenesTest, KeepsWhatClientsAddedToAWatchedScene) {
  ASSERT_TRUE(scenes_.update({watched(scene_of("room", room_))}));
  const auto room = store_.find("room");
  store_.change("room", {scene::SceneChange::Kind::kPut, "crate", room->objects[0]->source, {}});
  folder_.write("room.obj", kTwoTriangles);
  scenes_.look_at_files();
  scenes_.look_at_files();
  EXPECT_EQ(store_.find("room")->index.size(), 3U);
  EXPECT_NE(store_.find("room")->find("crate"), nullptr);
}

TEST_F(ConfiguredScenesTest, AWatchedFileThatIsGoneOrBadLeavesWhatWasThere) {
  ASSERT_TRUE(scenes_.update({watched(scene_of("room", room_))}));
  const auto before = store_.find("room");
  std::filesystem::remove(room_);
  for (int look = 0; look < 4; ++look) scenes_.look_at_files();
  EXPECT_EQ(store_.find("room"), before);
  EXPECT_EQ(count_of("is gone, what was read of it stays"), 1);
  folder_.write("room.obj", "v 1 nonsense");
  for (int look = 0; look < 4; ++look) scenes_.look_at_files();
  EXPECT_EQ(store_.find("room"), before);
  EXPECT_EQ(count_of("what was read before stays"), 1);
  folder_.write("room.obj", kTwoTriangles);
  for (int look = 0; look < 2; ++look) scenes_.look_at_files();
  EXPECT_EQ(store_.find("room")->index.size(), 2U);
}

TEST_F(ConfiguredScenesTest, AWatchedFileThatWasOnlyTouchedMakesNoRevision) {
  ASSERT_TRUE(scenes_.update({watched(scene_of("room", room_))}));
  const auto before = store_.find("room");
  std::filesystem::last_write_time(
      room_, std::filesystem::last_write_time(room_) + std::chrono::seconds(5));
  scenes_.look_at_files();
  scenes_.look_at_files();
  EXPECT_EQ(store_.find("room"), before);
}

TEST_F(ConfiguredScenesTest, ASceneThatAClientUnloadedStaysUnloaded) {
  ASSERT_TRUE(scenes_.update({watched(scene_of("room", room_))}));
  store_.remove("room");
  folder_.write("room.obj", kTwoTriangles);
  scenes_.look_at_files();
  scenes_.look_at_files();
  EXPECT_EQ(store_.find("room"), nullptr);
}

}  // namespace
}  // namespace camway::process
