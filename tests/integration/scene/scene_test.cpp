// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

using ::testing::HasSubstr;

constexpr char kCube[] =
    "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 0 0 4\nv 4 0 4\nv 4 4 4\nv 0 4 4\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

Pose at(double x, double y, double z) {
  Pose pose;
  pose.position_m = {x, y, z};
  return pose;
}

/// Returns a request straight along x at y = 2, z = 10.
PlanRequest flight(const std::string& scene) {
  PlanRequest request;
  request.scene = scene;
  request.keyframes.resize(2);
  request.keyframes[0].position_m = {-5, 2, 10};
  request.keyframes[1].position_m = {15, 2, 10};
  return request;
}

class SceneTest : public IntegrationTest {
 protected:
  void SetUp() override {
    IntegrationTest::SetUp();
    if (HasFatalFailure()) return;
    std::filesystem::create_directory(file("root"));
    std::ofstream(file("root/cube.obj")) << kCube;
    std::ofstream(file("outside.obj")) << kCube;
    std::filesystem::create_symlink(file("outside.obj"), file("root/link.obj"));
    std::ofstream(file("camwayd.toml"))
        << "[scenes]\nwrite_maps = true\nmirror_voxels = 1000000000\n";
    start_daemon_with_scenes({}, {"--config", file("camwayd.toml"), "--scene-roots", file("root")});
  }
};

TEST_F(SceneTest, PlansAroundWhatIsMoved) {
  Client client(patient());
  SceneMesh mesh;
  mesh.file = "cube.obj";
  const SceneAnswer loaded = client.load_scene("world", mesh, 0.25);
  ASSERT_TRUE(loaded.ok()) << loaded.error;
  const PlanResponse free = client.plan(flight("world"));
  ASSERT_TRUE(free.ok()) << free.error;
  EXPECT_TRUE(free.collisions.empty());
  EXPECT_EQ(free.scene_digest, loaded.scene.digest);

  const SceneAnswer put = client.put_object("world", "crate", SceneBox{{1, 3, 1}}, at(5, 2, 20));
  ASSERT_TRUE(put.ok()) << put.error;
  const SceneAnswer moved = client.move_object("world", "crate", at(5, 2, 10));
  ASSERT_TRUE(moved.ok()) << moved.error;
  EXPECT_EQ(moved.scene.revision, put.scene.revision + 1);
  const PlanResponse round = client.plan(flight("world"));
  ASSERT_TRUE(round.ok()) << round.error;
  EXPECT_FALSE(round.collisions.empty());
  EXPECT_EQ(round.scene_digest, moved.scene.digest);
  EXPECT_EQ(round.scene_revision, moved.scene.revision);

  OccupancyBatch batch;
  batch.scene = "world";
  batch.points_m = {{5.4, 2, 10}, {5.4, 2, 20}, {2, 2, 0}};
  const OccupancyAnswer occupied = client.occupancy(batch);
  ASSERT_TRUE(occupied.ok()) << occupied.error;
  EXPECT_EQ(occupied.points_occupied, (std::vector<bool>{true, false, true}));

  ASSERT_TRUE(client.remove_object("world", "crate").ok());
  const SceneAnswer described = client.describe_scene("world");
  ASSERT_EQ(described.objects.size(), 1U);
  EXPECT_EQ(described.objects[0].name, "world");
  EXPECT_EQ(described.scene.digest, loaded.scene.digest) << "all is as it was";
}

TEST_F(SceneTest, AFileThatIsWatchedIsReadAgain) {
  stop_daemon();
  start_daemon_with_scenes({"cube=" + file("root/cube.obj") + ",watch=yes"});
  Client client(patient());
  const SceneAnswer before = client.describe_scene("cube");
  ASSERT_TRUE(before.ok()) << before.error;
  std::string next = kCube;
  next.replace(next.find("f 1 4"), std::string::npos, "f 1 4 3\n");
  std::ofstream(file("next.obj")) << next;
  std::filesystem::rename(file("next.obj"), file("root/cube.obj"));
  ASSERT_TRUE(eventually([&] { return client.describe_scene("cube").scene.num_triangles == 1; }));
  EXPECT_EQ(client.describe_scene("cube").scene.revision, before.scene.revision + 1);
}

/// A scene's occupancy map is exported as a file and loaded as a scene.
TEST_F(SceneTest, ExportsAMapThatIsASceneAgain) {
  Client client(patient());
  SceneMesh mesh;
  mesh.file = "cube.obj";
  ASSERT_TRUE(client.load_scene("world", mesh, 0.05).ok());
  const SceneMap map = client.export_map("world");
  ASSERT_TRUE(map.ok()) << map.error;
  EXPECT_GT(map.bytes.size(), 48'000U) << "several pages";
  EXPECT_EQ(map.scene.name, "world");
  const SceneAnswer written = client.export_map_to("world", "voxels.bt");
  ASSERT_TRUE(written.ok()) << written.error;
  std::ifstream in(file("root/voxels.bt"), std::ios::binary);
  EXPECT_EQ(std::vector<std::uint8_t>(std::istreambuf_iterator<char>(in), {}), map.bytes);
  EXPECT_EQ(client.export_map_to("world", "../voxels.bt").status, Status::kInvalid);
  EXPECT_EQ(client.export_map_to("world", "cube.obj").status, Status::kInvalid);

  SceneMesh uploaded;
  uploaded.bytes = map.bytes;
  uploaded.format = "bt";
  ASSERT_TRUE(client.load_scene("copy", uploaded, 0.05).ok());
  SceneMesh below;
  below.file = "voxels.bt";
  const SceneAnswer loaded = client.load_scene("again", below, 0.05);
  ASSERT_TRUE(loaded.ok()) << loaded.error;
  const SceneAnswer copy = client.describe_scene("copy");
  EXPECT_EQ(copy.scene.digest, loaded.scene.digest);
  ASSERT_EQ(copy.objects.size(), 1U);
  EXPECT_EQ(copy.objects[0].kind, "occupancy map");
  EXPECT_EQ(client.export_map("again").bytes, map.bytes) << "the very same voxels";

  // A camera much smaller than a voxel: inside the wall, through the wall, and past it.
  const auto plan = [&](double from_z, double to_z) {
    PlanRequest request = flight("again");
    request.camera = {1.0, 1.0, 0.001};
    request.keyframes[0].position_m = {2.01, 2.01, from_z};
    request.keyframes[1].position_m = {2.02, 2.02, to_z};
    return client.plan(request);
  };
  const PlanResponse inside = plan(0.02, 0.03);
  EXPECT_EQ(inside.status, Status::kInvalid);
  EXPECT_EQ(inside.keyframe_faults.size(), 2U);
  const PlanResponse through = plan(-2.0, 2.0);
  EXPECT_NE(through.status, Status::kOk);
  EXPECT_FALSE(through.collisions.empty());
  const PlanResponse past = plan(-2.0, -1.0);
  EXPECT_TRUE(past.ok()) << past.error;
  EXPECT_TRUE(past.certified);
}

/// Points of a scan block the very next plan, until a later scan sees through them.
TEST_F(SceneTest, PlansAroundWhatASensorSees) {
  Client client(patient());
  ASSERT_TRUE(client.load_scene("world", {}).ok());
  SceneVoxels voxels;
  voxels.resolution_m = 0.5;
  voxels.sensor.max_range_m = 30.0;
  const SceneAnswer put = client.put_object("world", "seen", voxels, at(0, 0, 0.2));
  ASSERT_TRUE(put.ok()) << put.error;
  EXPECT_EQ(put.objects[0].kind, "occupancy map");
  EXPECT_TRUE(client.plan(flight("world")).collisions.empty());

  std::vector<std::array<double, 3>> wall;
  for (double y = -3.0; y <= 7.0; y += 0.1) {
    for (double z = 5.0; z <= 15.0; z += 0.1) wall.push_back({5.25, y, z});
  }
  const SceneAnswer scanned = client.insert_scan("world", "seen", wall, {-5, 2, 10});
  ASSERT_TRUE(scanned.ok()) << scanned.error;
  EXPECT_EQ(scanned.scene.revision, put.scene.revision + 1);
  const PlanResponse round = client.plan(flight("world"));
  EXPECT_FALSE(round.collisions.empty());
  EXPECT_EQ(round.scene_revision, scanned.scene.revision);

  std::vector<std::array<double, 3>> beyond;
  for (const auto& point : wall) beyond.push_back({20.25, point[1], point[2]});
  for (int i = 0; i < 8; ++i) {
    const SceneAnswer again = client.insert_scan("world", "seen", beyond, {-5, 2, 10});
    ASSERT_TRUE(again.ok()) << again.error;
  }
  EXPECT_TRUE(client.plan(flight("world")).collisions.empty());
  EXPECT_EQ(client.insert_scan("world", "crate", wall, {-5, 2, 10}).status, Status::kInvalid);
  EXPECT_EQ(client.insert_scan("world", "seen", {{1e9, 0, 0}}, {0, 0, 0}).status, Status::kInvalid);
}

TEST_F(SceneTest, ReadsNothingOutsideItsRoots) {
  Client client(patient());
  for (const std::string& name :
       {std::string("link.obj"), std::string("../outside.obj"), file("outside.obj")}) {
    SceneMesh mesh;
    mesh.file = name;
    const SceneAnswer answer = client.load_scene("world", mesh);
    EXPECT_EQ(answer.status, Status::kInvalid);
    EXPECT_THAT(answer.error, HasSubstr(name));
  }
  EXPECT_TRUE(client.list_scenes().scenes.empty());
}

TEST_F(SceneTest, TakesALargeUploadAndGoesOnAfterAnInterruption) {
  std::ostringstream text;  // some 3 MB
  for (int i = 0; i < 40'000; ++i) {
    text << "v " << i << " 0 0\nv " << i << " 1 0\nv " << i << " 0 1\nf -3 -2 -1\n";
  }
  const std::string bytes = text.str();
  SceneMesh mesh;
  mesh.bytes.assign(bytes.begin(), bytes.end());
  mesh.format = "obj";
  ClientOptions hasty = patient();
  hasty.client_id = "uploader";
  hasty.deadline_s = 0.02;
  Client(hasty).load_scene("comb", mesh);  // most likely ends in the middle
  ClientOptions options = patient();
  options.client_id = "uploader";
  const SceneAnswer answer = Client(options).load_scene("comb", mesh);
  ASSERT_TRUE(answer.ok()) << answer.error;
  EXPECT_EQ(answer.scene.num_triangles, 40'000);
}

TEST_F(SceneTest, GoesBackToAnEarlierRevision) {
  Client client(patient());
  SceneMesh mesh;
  mesh.file = "cube.obj";
  const SceneAnswer loaded = client.load_scene("world", mesh, 0.25);
  ASSERT_TRUE(loaded.ok()) << loaded.error;
  const SceneAnswer put = client.put_object("world", "wall", SceneBox{{1, 8, 8}}, at(5, 2, 10));
  ASSERT_TRUE(put.ok()) << put.error;
  EXPECT_FALSE(client.plan(flight("world")).collisions.empty());
  const SceneAnswer restored = client.restore_scene("world", loaded.scene.revision);
  ASSERT_TRUE(restored.ok()) << restored.error;
  EXPECT_EQ(restored.scene.revision, put.scene.revision + 1);
  EXPECT_EQ(restored.scene.digest, loaded.scene.digest);
  EXPECT_EQ(client.export_map("world").scene.revision, restored.scene.revision);
  EXPECT_TRUE(client.plan(flight("world")).collisions.empty());

  EXPECT_EQ(client.scene_history("world").revisions.back().restored_revision,
            loaded.scene.revision);
}

TEST_F(SceneTest, AHistoryMayBeLongerThanAMessage) {
  Client client(patient());
  ASSERT_TRUE(client.load_scene("long", {}).ok());
  const std::string crate(64, 'c');
  ASSERT_TRUE(client.put_object("long", crate, SceneBox{{1, 1, 1}}).ok());
  for (int i = 0; i < 600; ++i) {
    ASSERT_TRUE(client.move_object("long", crate, at(0.001 * i, 0, 0)).ok());
  }
  const SceneAnswer history = client.scene_history("long");
  ASSERT_TRUE(history.ok()) << history.error;
  ASSERT_EQ(history.revisions.size(), 602U);
  for (std::size_t i = 0; i < history.revisions.size(); ++i) {
    EXPECT_EQ(history.revisions[i].revision, static_cast<std::int64_t>(i) + 1);
  }
  EXPECT_EQ(history.scene.revision, history.revisions.back().revision);
}

TEST_F(SceneTest, TheCommandListsAndRestoresRevisions) {
  const auto camway = [&](std::vector<std::string> arguments, int code) {
    arguments.insert(arguments.begin(), {CAMWAY_BINARY, "scene"});
    Process process(arguments, file("camway.log"));
    EXPECT_EQ(process.wait(), code) << process.output();
    return process.output();
  };
  EXPECT_EQ(camway({"list"}, 0), "the daemon holds no scenes\n");
  camway({"load", "yard"}, 0);
  camway({"add", "yard", "crate", "--box", "1,1,1"}, 0);
  EXPECT_THAT(camway({"add", "yard", "ball", "--sphere", "1", "--chord-error", "1e-9"}, 2),
              HasSubstr("--chord-error: 1e-09 m needs more than 2000000 triangles"));
  camway({"remove", "yard", "crate"}, 0);
  const std::string listed = camway({"history", "yard"}, 0);
  EXPECT_THAT(listed, HasSubstr("  1: 20"));
  EXPECT_THAT(listed, HasSubstr("Z, put crate, by "));
  const auto digest = [](const std::string& text) { return text.substr(text.find("digest")); };
  const std::string restored = camway({"restore", "yard", "--revision", "2"}, 0);
  EXPECT_THAT(restored, HasSubstr("yard revision 4: 12 triangles"));
  const std::string copy = camway({"restore", "yard", "--revision", "4", "--as", "copy"}, 0);
  EXPECT_THAT(copy, HasSubstr("copy revision 1: 12 triangles"));
  EXPECT_EQ(digest(copy), digest(restored));
  EXPECT_THAT(camway({"history", "yard"}, 0), HasSubstr("restore of 2, by "));
  EXPECT_THAT(camway({"restore", "yard", "--revision", "9"}, 2),
              HasSubstr("9 of scene 'yard' is not kept; 1 to 4 are"));
  EXPECT_EQ(camway({"unload", "copy"}, 0), "copy is unloaded\n");
  EXPECT_THAT(camway({"load", "folder", "--upload", file("root")}, 2), HasSubstr("cannot read"));
}

/// Returns whether the process blocks this signal.
bool holds_back(const Process& process, int number) {
  std::istringstream status(read_file("/proc/" + std::to_string(process.pid()) + "/status"));
  for (std::string line; std::getline(status, line);) {
    if (!line.starts_with("SigBlk:")) continue;
    return (std::stoull(line.substr(7), nullptr, 16) >> (number - 1) & 1U) != 0;
  }
  return false;
}

TEST_F(SceneTest, TheCommandLeavesAllAsItWasAtItsDeadlineAndOnASignal) {
  Client client(patient());
  ASSERT_TRUE(client.load_scene("fine", {}, 0.002).ok());
  const std::vector<std::string> minutes{CAMWAY_BINARY, "scene", "add",     "fine",
                                         "hangar",      "--box", "14,14,14"};
  std::vector<std::string> arguments = minutes;
  arguments.insert(arguments.end(), {"--deadline-s", "0.2"});
  Process late(arguments, file("late.log"));
  EXPECT_EQ(late.wait(), 3) << late.output();
  EXPECT_THAT(late.output(), HasSubstr("the deadline passed"));
  Process cancelled(minutes, file("cancelled.log"));
  ASSERT_TRUE(eventually([&] { return holds_back(cancelled, SIGINT); }));
  cancelled.signal(SIGINT);
  EXPECT_EQ(cancelled.wait(), 3) << cancelled.output();
  EXPECT_THAT(cancelled.output(), HasSubstr("cancelled"));
  const SceneAnswer put = client.put_object("fine", "crate", SceneBox{{0.01, 0.01, 0.01}});
  ASSERT_TRUE(put.ok()) << put.error;
  EXPECT_EQ(put.scene.revision, 2) << "nothing else was changed";
}

TEST_F(SceneTest, TheCommandMovesWhatItIsToldAndRefusesWhatIsAmbiguous) {
  Client client(patient());
  ASSERT_TRUE(client.load_scene("yard", {}).ok());
  std::string said;
  const auto camway = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {CAMWAY_BINARY, "scene"});
    Process process(arguments, file("camway.log"));
    const std::optional<int> code = process.wait();
    said = process.output();
    return code.value_or(-1);
  };
  const auto pose = [&] { return client.describe_scene("yard").objects.at(0).pose; };
  using Position = std::array<double, 3>;
  using Orientation = std::array<double, 4>;
  ASSERT_EQ(camway({"add", "yard", "crate", "--box", "1,1,1", "--position", "4,0.5,2"}), 0) << said;
  EXPECT_EQ(camway({"move", "yard", "crate", "--orientation", "0,0,1,0"}), 0) << said;
  EXPECT_EQ(pose().position_m, (Position{4, 0.5, 2}));
  EXPECT_EQ(pose().orientation_wxyz, (Orientation{0, 0, 1, 0}));
  EXPECT_EQ(camway({"move", "yard", "crate", "--position", "5,0.5,2"}), 0) << said;
  EXPECT_EQ(pose().position_m, (Position{5, 0.5, 2}));
  EXPECT_EQ(pose().orientation_wxyz, (Orientation{0, 0, 1, 0}));

  EXPECT_EQ(camway({"move", "yard", "crate"}), 2);
  EXPECT_THAT(said, HasSubstr("--position, --orientation or both"));
  EXPECT_EQ(camway({"move", "yard", "crate", "--orientation", "0,0,0,0"}), 2);
  EXPECT_THAT(said, HasSubstr("0,0,0,0 is no quaternion"));
  EXPECT_EQ(camway({"add", "yard", "both", "--box", "1,1,1", "--sphere", "1"}), 2);
  EXPECT_THAT(said, HasSubstr("no more than one"));
  EXPECT_EQ(camway({"move", "yard", "nothing", "--position", "1,1,1"}), 2) << said;
  EXPECT_EQ(pose().position_m, (Position{5, 0.5, 2}));
}

}  // namespace
}  // namespace camway::integration
