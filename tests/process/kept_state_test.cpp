// SPDX-License-Identifier: MIT
//
// Configured scenes of a process that keeps its state, and of the next one with the same folder.
#include "daemon/process/kept_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "daemon/process/configured_scenes.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "tests/support/captured_log.h"
#include "tests/support/temporary_folder.h"

namespace camway::process {
namespace {

using testing::CapturedLog;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

constexpr char kFloor[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
constexpr char kLargerFloor[] = "v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n";

scene::SceneChange crate() {
  scene::Mesh mesh = *scene::box_mesh(geometry::Vec3(1, 1, 1));
  const scene::ImportReport report = scene::report_of(mesh, "box");
  return {scene::SceneChange::Kind::kPut,
          "crate",
          scene::make_source(scene::ObjectKind::kBox, std::move(mesh), report, {}),
          {}};
}

/// A daemon's scenes, as its main function puts them together.
struct Started {
  Started(const std::string& folder, const CapturedLog& log)
      : state(*KeptState::open({.folder = folder})), store({}, &state->scenes()) {
    EXPECT_EQ(state->load_into(store, *log.log()), "");
    configured.emplace(store, log.log(), std::nullopt, &state->log());
  }

  std::unique_ptr<KeptState> state;
  scene::SceneStore store;
  std::optional<ConfiguredScenes> configured;
};

class KeptStateTest : public ::testing::Test {
 protected:
  [[nodiscard]] SceneArgument room(double scale = 1.0) const {
    SceneArgument scene;
    scene.name = "room";
    scene.file = file_;
    scene.options.import.scale = scale;
    return scene;
  }
  [[nodiscard]] std::string state() const { return (folder_.path() / "state").string(); }

  /// Loads the room and puts a crate into it. Returns its digest.
  std::string first_process() {
    Started first(state(), log_);
    EXPECT_TRUE(first.configured->update({room()}));
    return first.store.change("room", crate()).snapshot->digest;
  }

  TemporaryFolder folder_;
  std::string file_ = folder_.write("room.obj", kFloor);
  CapturedLog log_;
};

TEST_F(KeptStateTest, ASceneThatIsKeptIsNotReadAgain) {
  const std::string digest = first_process();
  Started next(state(), log_);
  ASSERT_TRUE(next.configured->update({room()}));
  EXPECT_EQ(next.store.find("room")->revision, 2U);
  EXPECT_EQ(next.store.find("room")->digest, digest);
  EXPECT_THAT(log_.text(), HasSubstr("scene kept"));
}

TEST_F(KeptStateTest, AChangedFileReplacesItsOwnObject) {
  const std::string digest = first_process();
  folder_.write("room.obj", kLargerFloor);
  Started next(state(), log_);
  ASSERT_TRUE(next.configured->update({room()}));
  const auto snapshot = next.store.find("room");
  EXPECT_EQ(snapshot->revision, 3U);
  EXPECT_NE(snapshot->digest, digest);
  EXPECT_NE(snapshot->find("crate"), nullptr);
}

TEST_F(KeptStateTest, AFileThatIsGoneLeavesWhatWasKept) {
  const std::string digest = first_process();
  std::filesystem::remove(file_);
  Started next(state(), log_);
  ASSERT_TRUE(next.configured->update({room()}));
  EXPECT_EQ(next.store.find("room")->digest, digest);
  EXPECT_THAT(log_.text(), HasSubstr("scene file is gone"));
}

TEST_F(KeptStateTest, AnotherWayToReadTheFileReplacesItsOwnObject) {
  first_process();
  Started next(state(), log_);
  ASSERT_TRUE(next.configured->update({room(2.0)}));
  EXPECT_EQ(next.store.find("room")->revision, 3U);
  EXPECT_DOUBLE_EQ(next.store.find("room")->find("room")->source->report.scale, 2.0);
  EXPECT_NE(next.store.find("room")->find("crate"), nullptr);
}

TEST_F(KeptStateTest, OtherOptionsOfTheSceneBeginAHistory) {
  first_process();
  Started next(state(), log_);
  SceneArgument with_map = room();
  with_map.options.occupancy_resolution_m = 0.5;
  ASSERT_TRUE(next.configured->update({with_map}));
  EXPECT_EQ(next.store.find("room")->revision, 3U) << "revisions never fall";
  EXPECT_TRUE(next.store.find("room")->occupancy);
  EXPECT_EQ(next.store.find("room")->find("crate"), nullptr);
}

TEST_F(KeptStateTest, RemembersWhoRemovedAScene) {
  first_process();
  {
    Started next(state(), log_);
    ASSERT_TRUE(next.store.remove("room", {}, "request 1").snapshot);
  }
  Started last(state(), log_);
  EXPECT_TRUE(last.store.removed_by("request 1"));
  EXPECT_FALSE(last.store.removed_by("request 2"));
  // A new scene of that name is not the one that the request removed.
  ASSERT_TRUE(last.configured->update({room()}));
  EXPECT_EQ(last.store.remove("room", {}, "request 1").fault, scene::StoreFault::kNone);
  EXPECT_TRUE(last.store.find("room"));
}

TEST_F(KeptStateTest, ASceneThatIsNotConfiguredAnyMoreGoes) {
  first_process();
  {
    Started next(state(), log_);
    next.store.put(scene::assemble("of a client", 1, {}, {}));
    ASSERT_TRUE(next.configured->update({}));
    EXPECT_EQ(next.store.find("room"), nullptr);
  }
  Started last(state(), log_);
  ASSERT_TRUE(last.configured->update({room()}));
  EXPECT_EQ(last.store.find("room")->revision, 3U) << "revisions never fall";
  EXPECT_NE(last.store.find("of a client"), nullptr);
}

TEST_F(KeptStateTest, ASecondOneIsRefused) {
  const Started first(state(), log_);
  const auto second = KeptState::open({.folder = state()});
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error, HasSubstr(state()));
}

}  // namespace
}  // namespace camway::process
