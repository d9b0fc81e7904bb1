// SPDX-License-Identifier: MIT
//
// Configured scenes of several fronts that share a log.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/process/configured_scenes.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "tests/scene/log/memory_log.h"
#include "tests/support/captured_log.h"
#include "tests/support/temporary_folder.h"

namespace camway::process {
namespace {

using testing::CapturedLog;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::TemporaryFolder;

constexpr char kFloorOfAll[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// The scenes of a fleet, and the fronts that configure them.
class SharedScenesTest : public ::testing::Test {
 protected:
  /// A start of a front.
  std::unique_ptr<ConfiguredScenes> front(const std::string& id) {
    return std::make_unique<ConfiguredScenes>(store_, log_.log(), std::nullopt, &shared_, id);
  }
  [[nodiscard]] SceneArgument room(double scale = 1.0) const {
    SceneArgument scene;
    scene.name = "room";
    scene.file = file_;
    scene.options.import.scale = scale;
    return scene;
  }
  [[nodiscard]] SceneArgument room_with_map(double resolution_m) const {
    SceneArgument scene = room();
    scene.options.occupancy_resolution_m = resolution_m;
    return scene;
  }
  void put_crate() {
    scene::Mesh mesh = *scene::box_mesh(geometry::Vec3(1, 1, 1));
    const scene::ImportReport report = scene::report_of(mesh, "box");
    const auto source = scene::make_source(scene::ObjectKind::kBox, std::move(mesh), report,
                                           store_.find("room")->options);
    ASSERT_TRUE(
        store_.change("room", {scene::SceneChange::Kind::kPut, "crate", source, {}}).snapshot);
  }
  [[nodiscard]] bool has_room() const { return store_.find("room") != nullptr; }

  TemporaryFolder folder_;
  std::string file_ = folder_.write("room.obj", kFloorOfAll);
  CapturedLog log_;
  testing::MemoryLog shared_;
  scene::SceneStore store_;
};

TEST_F(SharedScenesTest, ASceneStaysUntilTheLastFrontDropsIt) {
  ASSERT_TRUE(front("one")->update({room()}));
  ASSERT_TRUE(front("two")->update({room()}));
  const auto one = front("one");
  ASSERT_TRUE(one->update({}));
  EXPECT_TRUE(has_room());
  EXPECT_THAT(log_.text(),
              HasSubstr("info scene kept: another front configures it scene=room front=two"));
  ASSERT_TRUE(front("two")->update({}));
  EXPECT_FALSE(has_room());
  EXPECT_THAT(log_.text(), HasSubstr("scene unloaded"));
}

TEST_F(SharedScenesTest, SoItDoesAtAReload) {
  const auto one = front("one");
  const auto two = front("two");
  ASSERT_TRUE(one->update({room()}));
  ASSERT_TRUE(two->update({room()}));
  ASSERT_TRUE(two->update({}));
  EXPECT_TRUE(has_room());
  ASSERT_TRUE(one->update({}));
  EXPECT_FALSE(has_room());
}

TEST_F(SharedScenesTest, AFrontWantsASceneThoughItCannotReadItsFile) {
  ASSERT_TRUE(front("one")->update({room()}));
  std::filesystem::remove(file_);
  ASSERT_TRUE(front("two")->update({room()}));
  EXPECT_THAT(log_.text(), HasSubstr("scene file is gone"));
  ASSERT_TRUE(front("one")->update({}));
  EXPECT_TRUE(has_room());
}

TEST_F(SharedScenesTest, OfTwoThatDropItAtOnceOneRemovesIt) {
  ASSERT_TRUE(front("one")->update({room()}));
  ASSERT_TRUE(front("two")->update({room()}));
  // Both say so before either looks.
  SceneOrigins(&shared_, "one").mark_dropped("room", true);
  SceneOrigins(&shared_, "two").mark_dropped("room", true);
  ASSERT_TRUE(front("one")->update({}));
  EXPECT_FALSE(has_room());
  ASSERT_TRUE(front("two")->update({}));
}

TEST_F(SharedScenesTest, WhatAFrontThatEndedBeganToDropTheNextOneDrops) {
  ASSERT_TRUE(front("one")->update({room()}));
  SceneOrigins(&shared_, "one").mark_dropped("room", true);
  ASSERT_TRUE(front("one")->update({}));
  EXPECT_FALSE(has_room());
}

TEST_F(SharedScenesTest, ASceneThatIsWantedAfterAllIsNotDroppedByOthers) {
  ASSERT_TRUE(front("one")->update({room()}));
  ASSERT_TRUE(front("two")->update({room()}));
  SceneOrigins(&shared_, "one").mark_dropped("room", true);
  ASSERT_TRUE(front("one")->update({room()}));
  ASSERT_TRUE(front("two")->update({}));
  EXPECT_TRUE(has_room());
}

TEST_F(SharedScenesTest, NothingIsRemovedWhereTheNotesOfOthersAreNotKnown) {
  ASSERT_TRUE(front("one")->update({room()}));
  shared_.fault = scene::AppendFault::kBroken;
  ASSERT_TRUE(front("one")->update({}));
  EXPECT_TRUE(has_room());
  EXPECT_THAT(log_.text(), HasSubstr("warning scene is not unloaded"));
  shared_.fault = scene::AppendFault::kNone;
  ASSERT_TRUE(front("one")->update({}));
  EXPECT_FALSE(has_room()) << "the next start drops it";
}

TEST_F(SharedScenesTest, OtherWaysToReadTheFileReplaceItsObjectOnly) {
  ASSERT_TRUE(front("one")->update({room()}));
  put_crate();
  ASSERT_TRUE(front("one")->update({room(2.0)}));
  const auto after = store_.find("room");
  EXPECT_EQ(after->revision, 3U);
  EXPECT_NE(after->find("crate"), nullptr);
  EXPECT_DOUBLE_EQ(after->find("room")->source->report.scale, 2.0);
  ASSERT_TRUE(front("one")->update({room(2.0)}));
  EXPECT_EQ(store_.find("room"), after) << "nothing is read again";
}

TEST_F(SharedScenesTest, OfTwoThatReadTheFileInOtherWaysTheLastOneCounts) {
  const auto scale = [&] { return store_.find("room")->find("room")->source->report.scale; };
  ASSERT_TRUE(front("one")->update({room()}));
  ASSERT_TRUE(front("two")->update({room(2.0)}));
  EXPECT_EQ(scale(), 2.0);
  // Its own file and options are as they were at its last start.
  ASSERT_TRUE(front("one")->update({room()}));
  EXPECT_EQ(scale(), 1.0);
  EXPECT_THAT(log_.text(), HasSubstr("warning another front reads the scene with another scale"));
}

TEST_F(SharedScenesTest, OptionsThatASceneOfAnotherFrontDoesNotHaveAreNamed) {
  ASSERT_TRUE(front("one")->update({room_with_map(0.5)}));
  const auto before = store_.find("room");
  for (int start = 0; start < 2; ++start) {
    log_.clear();
    ASSERT_TRUE(front("two")->update({room_with_map(0.25)}));
    EXPECT_EQ(store_.find("room"), before);
    EXPECT_THAT(log_.text(), HasSubstr("option=occupancy_resolution_m kept=0.5 configured=0.25"));
  }
  log_.clear();
  ASSERT_TRUE(front("one")->update({room_with_map(0.5)}));
  EXPECT_THAT(log_.text(), Not(HasSubstr("warning")));
}

TEST_F(SharedScenesTest, OptionsOfTheSceneThatItsFrontChangesMakeItAnew) {
  ASSERT_TRUE(front("one")->update({room_with_map(0.5)}));
  put_crate();
  ASSERT_TRUE(front("one")->update({room_with_map(0.25)}));
  EXPECT_EQ(store_.find("room")->options.occupancy_resolution_m, 0.25);
  EXPECT_EQ(store_.find("room")->find("crate"), nullptr);
  EXPECT_THAT(log_.text(), HasSubstr("warning scene is read anew, what clients added to it goes"));
}

}  // namespace
}  // namespace camway::process
