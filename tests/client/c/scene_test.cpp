// SPDX-License-Identifier: MIT
#include <camway/camway.h>
#include <camway/client.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include <camway/scene_response_t.hpp>

#include "client/c/scene_shapes.h"
#include "daemon/scene/import/readers/ply_reader.h"
#include "lcmtypes/wire/check.h"
#include "tests/client/c/c_client.h"
#include "tests/client/client_fixture.h"
#include "tests/client/fake_daemon.h"
#include "tests/support/random.h"

namespace camway {
namespace {

using ::testing::HasSubstr;
using testing_support::Bytes;
using testing_support::CClient;
using testing_support::FakeDaemon;
using testing_support::quick;

using CSceneTest = testing_support::ClientTest;

scene_info_t scene_named(const std::string& name) {
  scene_info_t info{};
  info.name = name;
  info.digest = "d-" + name;
  info.revision = 5;
  info.num_triangles = 12;
  info.bounds_max_m[1] = 2.5;
  return info;
}

std::vector<Bytes> info_of(const scene_request_t& asked) {
  scene_response_t response{};
  response.client_id = asked.client_id;
  response.request_id = asked.request_id;
  response.scene = scene_named(asked.scene);
  if (asked.operation == scene_request_t::LIST) {
    for (const char* const name : {"a", "b"}) response.scenes.push_back(scene_named(name));
    response.num_scenes = static_cast<std::int32_t>(response.scenes.size());
  }
  response.total = response.num_scenes;
  return {wire::encode(response)};
}

TEST_F(CSceneTest, EveryCallIsSentAsTheClientOfCxxSendsIt) {
  std::vector<scene_request_t> sent;
  FakeDaemon daemon;
  daemon.on_scene = [&](const scene_request_t& asked) {
    sent.push_back(asked);
    return info_of(asked);
  };
  daemon.start();
  CClient client;
  Client cxx(quick());
  const camway_pose pose = {{1, 2, 3}, {0, 1, 0, 0}};
  const Pose same = {{1, 2, 3}, {0, 1, 0, 0}};
  const double size_m[3] = {1, 2, 3};
  camway_mesh_file file;
  camway_mesh_file_init(&file, sizeof file);
  file.file = "chair.obj";
  file.scale = 0.01;
  file.up = 1;
  SceneMesh mesh;
  mesh.file = "chair.obj";
  mesh.scale = 0.01;
  mesh.up = SceneMesh::Up::kZToY;
  camway_scan_map map;
  camway_scan_map_init(&map, sizeof map);
  map.resolution_m = 0.1;
  const camway_scan_map told = {sizeof told, 1, 0.2, 0.8, 0.3, 0.2, 0.9, 7.0};
  camway_client* const c = client.get();
  const std::vector<std::pair<std::function<camway_status()>, std::function<SceneAnswer()>>> calls =
      {
          {[&] { return camway_scene_put_box(c, "s", "o", size_m, &pose, nullptr); },
           [&] {
             return cxx.put_object("s", "o", SceneBox{{1, 2, 3}}, same);
           }},
          {[&] { return camway_scene_put_box(c, "s", "o", size_m, nullptr, nullptr); },
           [&] {
             return cxx.put_object("s", "o", SceneBox{{1, 2, 3}});
           }},
          {[&] { return camway_scene_put_sphere(c, "s", "o", 0.5, &pose, nullptr); },
           [&] {
             return cxx.put_object("s", "o", SceneSphere{0.5, 0.0}, same);
           }},
          {[&] { return camway_scene_put_cylinder(c, "s", "o", 0.5, 2.0, &pose, nullptr); },
           [&] {
             return cxx.put_object("s", "o", SceneCylinder{0.5, 2.0, 0.0}, same);
           }},
          {[&] { return camway_scene_put_file(c, "s", "o", &file, &pose, nullptr); },
           [&] { return cxx.put_object("s", "o", mesh, same); }},
          {[&] { return camway_scene_load(c, "s", &file, 0.1, nullptr); },
           [&] { return cxx.load_scene("s", mesh, 0.1); }},
          {[&] { return camway_scene_load(c, "s", nullptr, 0.0, nullptr); },
           [&] { return cxx.load_scene("s", {}); }},
          {[&] { return camway_scene_move(c, "s", "o", &pose, nullptr); },
           [&] { return cxx.move_object("s", "o", same); }},
          {[&] { return camway_scene_remove(c, "s", "o", nullptr); },
           [&] { return cxx.remove_object("s", "o"); }},
          {[&] { return camway_scene_put_scan_map(c, "s", "o", &map, &pose, nullptr); },
           [&] {
             return cxx.put_object("s", "o", SceneVoxels{0.1, {}, {}}, same);
           }},
          {[&] { return camway_scene_put_scan_map(c, "s", "o", &told, nullptr, nullptr); },
           [&] {
             return cxx.put_object(
                 "s", "o",
                 SceneVoxels{0.2, SceneMesh::Unknown::kOccupied, {0.8, 0.3, 0.2, 0.9, 7.0}});
           }},
          {[&] { return camway_scene_restore(c, "s", 4, "t", nullptr); },
           [&] { return cxx.restore_scene("s", 4, "t"); }},
          {[&] { return camway_scene_restore(c, "s", 4, nullptr, nullptr); },
           [&] { return cxx.restore_scene("s", 4); }},
          {[&] { return camway_scene_history(c, "s", nullptr); },
           [&] { return cxx.scene_history("s"); }},
          {[&] { return camway_scene_export_map(c, "s", "f.bt", nullptr); },
           [&] { return cxx.export_map_to("s", "f.bt"); }},
          {[&] { return camway_scene_unload(c, "s", nullptr); },
           [&] { return cxx.unload_scene("s"); }},
      };
  for (const auto& [in_c, in_cxx] : calls) {
    EXPECT_EQ(in_c(), CAMWAY_OK) << camway_last_error();
    EXPECT_TRUE(in_cxx().ok());
  }
  daemon.stop();
  ASSERT_EQ(sent.size(), 2 * calls.size());
  for (scene_request_t& request : sent) {
    request.client_id.clear();
    request.request_id = request.utime = 0;
  }
  for (std::size_t i = 0; i < sent.size(); i += 2) {
    EXPECT_EQ(wire::encode(sent[i]), wire::encode(sent[i + 1])) << "call " << i / 2;
  }
}

TEST_F(CSceneTest, AnswersListScenes) {
  FakeDaemon daemon;
  daemon.on_scene = info_of;
  daemon.start();
  CClient client;
  camway_scene_answer* list = nullptr;
  ASSERT_EQ(camway_scene_list(client.get(), &list), CAMWAY_OK) << camway_last_error();
  std::size_t count = 0;
  ASSERT_EQ(camway_scene_answer_num_scenes(list, &count), CAMWAY_OK);
  ASSERT_EQ(count, 2u);
  camway_scene_info info;
  ASSERT_EQ(camway_scene_answer_scene_at(list, 1, &info, sizeof info), CAMWAY_OK);
  EXPECT_STREQ(info.name, "b");
  EXPECT_STREQ(info.digest, "d-b");
  EXPECT_EQ(info.revision, 5);
  EXPECT_EQ(info.bounds_max_m[1], 2.5);
  EXPECT_EQ(info.struct_size, sizeof info);
  EXPECT_EQ(camway_scene_answer_scene_at(list, 2, &info, sizeof info), CAMWAY_INVALID);
  EXPECT_THAT(camway_last_error(), HasSubstr("index: is 2"));
  ASSERT_EQ(camway_scene_answer_num_objects(list, &count), CAMWAY_OK);
  EXPECT_EQ(count, 0u);
  EXPECT_STREQ(camway_scene_answer_message(list), "");
  EXPECT_EQ(camway_scene_answer_free(list), CAMWAY_OK);
  EXPECT_EQ(camway_scene_answer_free(list), CAMWAY_BAD_ARGUMENT);
}

TEST_F(CSceneTest, AHistoryListsRevisions) {
  FakeDaemon daemon;
  daemon.on_scene = [](const scene_request_t& asked) {
    scene_response_t response{};
    response.client_id = asked.client_id;
    response.request_id = asked.request_id;
    response.scene = scene_named(asked.scene);
    response.changes.resize(2);
    response.changes[0].revision = 3;
    response.changes[0].operation = "load";
    response.changes[1] = {4, 1'700'000'000'000'000, "restore", "chair", "me", 2};
    response.num_changes = response.total = 2;
    return std::vector<Bytes>{wire::encode(response)};
  };
  daemon.start();
  CClient client;
  camway_scene_answer* history = nullptr;
  ASSERT_EQ(camway_scene_history(client.get(), "s", &history), CAMWAY_OK) << camway_last_error();
  std::size_t count = 0;
  ASSERT_EQ(camway_scene_answer_num_revisions(history, &count), CAMWAY_OK);
  ASSERT_EQ(count, 2u);
  camway_scene_revision revision;
  ASSERT_EQ(camway_scene_answer_revision_at(history, 0, &revision, sizeof revision), CAMWAY_OK);
  EXPECT_EQ(revision.revision, 3);
  EXPECT_STREQ(revision.operation, "load");
  EXPECT_STREQ(revision.object, "");
  EXPECT_STREQ(revision.client_id, "");
  ASSERT_EQ(camway_scene_answer_revision_at(history, 1, &revision, sizeof revision), CAMWAY_OK);
  EXPECT_EQ(revision.revision, 4);
  EXPECT_EQ(revision.utime, 1'700'000'000'000'000);
  EXPECT_STREQ(revision.operation, "restore");
  EXPECT_STREQ(revision.object, "chair");
  EXPECT_STREQ(revision.client_id, "me");
  EXPECT_EQ(revision.restored_revision, 2);
  EXPECT_EQ(revision.struct_size, sizeof revision);
  EXPECT_EQ(camway_scene_answer_revision_at(history, 2, &revision, sizeof revision),
            CAMWAY_INVALID);
  camway_scene_answer_free(history);
}

TEST_F(CSceneTest, AFailureGivesNoHandle) {
  FakeDaemon daemon;
  daemon.on_scene = [](const scene_request_t& asked) {
    scene_response_t response{};
    response.client_id = asked.client_id;
    response.request_id = asked.request_id;
    response.status = scene_response_t::STATUS_UNKNOWN_SCENE;
    response.message = "no such scene";
    return std::vector<Bytes>{wire::encode(response)};
  };
  daemon.start();
  CClient client;
  const std::int64_t handles = camway_num_handles();
  int anything = 0;
  auto* found = reinterpret_cast<camway_scene_answer*>(&anything);
  EXPECT_EQ(camway_scene_remove(client.get(), "s", "o", &found), CAMWAY_UNKNOWN_SCENE);
  EXPECT_EQ(found, nullptr);
  EXPECT_THAT(camway_last_error(), HasSubstr("no such scene"));
  EXPECT_EQ(camway_num_handles(), handles);
}

TEST(CSceneShapes, AMeshOfACallerIsReadBackBitForBit) {
  testing::Random random(11);
  std::vector<double> vertices_m(3 * 40);
  for (double& coordinate : vertices_m) coordinate = random.uniform(-1e3, 1e3);
  std::vector<std::uint32_t> corners(3 * 60);
  for (std::uint32_t& corner : corners) corner = static_cast<std::uint32_t>(random.integer(0, 39));
  const SceneMesh mesh = c::ply_of(vertices_m.data(), 40, corners.data(), 60);
  EXPECT_EQ(mesh.format, "ply");
  scene::mesh_readers::MeshCollector collector;
  scene::mesh_readers::PlyKind kind;
  const std::string bytes(mesh.bytes.begin(), mesh.bytes.end());
  EXPECT_EQ(scene::mesh_readers::read_ply(bytes, collector, kind), "");
  EXPECT_EQ(kind.relative_rounding, 0.0);
  const auto record = collector.finish(kind.format, kind.relative_rounding);
  ASSERT_EQ(record.vertices.size(), 40u);
  ASSERT_EQ(record.triangles.size(), 60u);
  EXPECT_EQ(
      std::memcmp(record.vertices.data(), vertices_m.data(), vertices_m.size() * sizeof(double)),
      0);
  EXPECT_EQ(
      std::memcmp(record.triangles.data(), corners.data(), corners.size() * sizeof(std::uint32_t)),
      0);
}

TEST(CSceneShapes, AQuaternionOfZerosIsNoRotation) {
  const camway_pose only_moved = {{1, 2, 3}, {0, 0, 0, 0}};
  EXPECT_EQ(c::pose_of(&only_moved).orientation_wxyz, (std::array<double, 4>{1, 0, 0, 0}));
  EXPECT_EQ(c::pose_of(&only_moved).position_m, (std::array<double, 3>{1, 2, 3}));
}

}  // namespace
}  // namespace camway
