// SPDX-License-Identifier: MIT
#include "daemon/service/scenes/scene_service.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include <camway/map_page_t.hpp>
#include <camway/missing_pages_t.hpp>

#include "daemon/service/scenes/sent_mesh.h"
#include "lcmtypes/wire/checksum.h"
#include "lcmtypes/wire/object_mesh.h"
#include "tests/service/running_service.h"
#include "tests/service/scenes/scene_sender.h"
#include "tests/support/temporary_folder.h"

namespace camway::service {
namespace {

using ::testing::HasSubstr;
using testing::RunningService;
using testing_scenes::put_box;
using testing_scenes::request_for;
using testing_scenes::Sender;
using testing_scenes::with_root;

class SceneServiceTest : public ::testing::Test {
 protected:
  /// Sends `message` and waits for the next message on `answers`.
  template <class Answer>
  Answer ask_on(const std::string& channel, const Bytes& message, const std::string& answers) {
    const std::size_t before = running_.transport.published_on(answers).size();
    running_.send_on(channel, message);
    const auto bytes = running_.transport.message_on(answers, before);
    if (!bytes) {
      ADD_FAILURE() << "no answer";
      return Answer{};
    }
    const auto decoded = wire::decode<Answer>(*bytes);
    EXPECT_TRUE(decoded.message) << decoded.fault.text("answer");
    return decoded.message.value_or(Answer{});
  }

  scene_response_t ask(const scene_request_t& request) {
    return ask_on<scene_response_t>(running_.channels.scene_request(), wire::encode(request),
                                    running_.channels.scene_response(request.client_id));
  }

  upload_status_t send_page(const upload_page_t& page) {
    return ask_on<upload_status_t>(running_.channels.upload(), wire::encode(page),
                                   running_.channels.upload_status(page.client_id));
  }

  /// Uploads the bytes, which must fit a page, and names them in `request`.
  void upload(const Bytes& bytes, scene_request_t& request) {
    upload_page_t page{};
    page.client_id = request.client_id;
    page.total_bytes = request.upload_bytes = static_cast<std::int64_t>(bytes.size());
    page.checksum = request.upload_checksum = wire::crc64(bytes.data(), bytes.size());
    page.page_checksum = page.checksum;
    page.num_bytes = static_cast<std::int32_t>(bytes.size());
    page.bytes = bytes;
    EXPECT_EQ(send_page(page).total_missing, 0);
  }

  RunningService running_;
};

TEST_F(SceneServiceTest, MakesChangesAndEndsAScene) {
  scene_request_t load = request_for(1, scene_request_t::LOAD, "hall-2");
  load.occupancy_resolution_m = 0.25;
  const scene_response_t loaded = ask(load);
  ASSERT_EQ(loaded.status, scene_response_t::STATUS_OK) << loaded.message;
  EXPECT_EQ(loaded.scene.name, "hall-2");
  EXPECT_EQ(loaded.scene.occupancy_resolution_m, 0.25);

  const scene_response_t put = ask(put_box(2, "hall-2", "crate"));
  ASSERT_EQ(put.status, scene_response_t::STATUS_OK) << put.message;
  EXPECT_EQ(put.scene.revision, loaded.scene.revision + 1);
  EXPECT_NE(put.scene.digest, loaded.scene.digest);
  EXPECT_EQ(put.scene.num_triangles, 12);
  ASSERT_EQ(put.objects.size(), 1U);
  EXPECT_EQ(put.objects[0].kind, "box");
  EXPECT_EQ(put.objects[0].digest, put.scene.digest) << "the only object";

  scene_request_t move = request_for(3, scene_request_t::MOVE, "hall-2", "crate");
  move.position_m[0] = 5.0;
  const scene_response_t moved = ask(move);
  ASSERT_EQ(moved.status, scene_response_t::STATUS_OK) << moved.message;
  EXPECT_EQ(moved.scene.bounds_min_m[0], 4.5);
  EXPECT_EQ(moved.objects[0].position_m[0], 5.0);
  EXPECT_TRUE(running_.scenes.find("hall-2")->occupancy->occupied_at({4.6, 0.45, 0.45}));

  const scene_response_t removed = ask(request_for(4, scene_request_t::REMOVE, "hall-2", "crate"));
  EXPECT_EQ(removed.scene.digest, loaded.scene.digest);
  EXPECT_EQ(removed.scene.revision, moved.scene.revision + 1);
  EXPECT_EQ(ask(request_for(5, scene_request_t::UNLOAD, "hall-2")).status,
            scene_response_t::STATUS_OK);
  EXPECT_EQ(running_.scenes.find("hall-2"), nullptr);
  const scene_response_t gone = ask(request_for(6, scene_request_t::UNLOAD, "hall-2"));
  EXPECT_EQ(gone.status, scene_response_t::STATUS_UNKNOWN_SCENE);
  EXPECT_THAT(gone.message, HasSubstr("'hall-2'"));
}

TEST_F(SceneServiceTest, MakesAChangeOnce) {
  static_cast<void>(ask(request_for(1, scene_request_t::LOAD, "s")));
  const scene_request_t put = put_box(2, "s", "crate");
  const scene_response_t first = ask(put);
  const scene_response_t again = ask(put);
  EXPECT_EQ(wire::encode(first), wire::encode(again));
  EXPECT_EQ(running_.scenes.find("s")->revision, 2U);
  const scene_response_t conflict = ask(put_box(2, "s", "crate", 2.0));
  EXPECT_EQ(conflict.status, scene_response_t::STATUS_INVALID);
  EXPECT_THAT(conflict.message, HasSubstr("request_id"));
}

TEST_F(SceneServiceTest, ListsWhatFitsAMessage) {
  static_cast<void>(ask(request_for(1, scene_request_t::LOAD, "s")));
  for (int i = 0; i < 400; ++i) {
    const std::string name = "object-with-a-name-of-some-length-" + std::to_string(1000 + i);
    ASSERT_EQ(ask(put_box(10 + i, "s", name)).status, scene_response_t::STATUS_OK);
  }
  std::vector<std::string> names;
  while (names.size() < 400) {
    scene_request_t describe = request_for(2, scene_request_t::DESCRIBE, "s");
    describe.first = static_cast<std::int32_t>(names.size());
    const scene_response_t answer = ask(describe);
    ASSERT_EQ(answer.total, 400);
    ASSERT_FALSE(answer.objects.empty());
    for (const scene_object_t& object : answer.objects) names.push_back(object.name);
  }
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  EXPECT_EQ(names.size(), 400U);
  const scene_response_t list = ask(request_for(3, scene_request_t::LIST, ""));
  EXPECT_EQ(list.total, 3);
  EXPECT_EQ(list.scenes.back().name, "s");
}

TEST_F(SceneServiceTest, LoadsWhatIsUploaded) {
  const std::string text = "OFF\n4 1 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n4 0 1 2 3\n";
  scene_request_t load = request_for(1, scene_request_t::LOAD, "square");
  load.upload_format = "off";
  load.scale = 0.5;
  upload(Bytes(text.begin(), text.end()), load);
  const scene_response_t loaded = ask(load);
  ASSERT_EQ(loaded.status, scene_response_t::STATUS_OK) << loaded.message;
  EXPECT_EQ(loaded.scene.num_triangles, 2);
  EXPECT_EQ(loaded.scene.bounds_max_m[0], 1.0);

  scene_request_t points = request_for(2, scene_request_t::PUT, "square", "dust");
  points.kind = scene_request_t::POINTS;
  points.cell_m = 0.5;
  const double coordinates[] = {0.1, 0.1, 5.1, 0.6, 0.1, 5.1};
  Bytes bytes(sizeof coordinates);
  std::memcpy(bytes.data(), coordinates, sizeof coordinates);
  upload(bytes, points);
  const scene_response_t put = ask(points);
  ASSERT_EQ(put.status, scene_response_t::STATUS_OK) << put.message;
  EXPECT_EQ(put.scene.num_triangles, 2 + 2 * 10);
  EXPECT_EQ(put.objects[0].kind, "point cloud");
}

/// The points of a survey, far from the origin, and then those of a scan in the same place.
TEST_F(SceneServiceTest, MakesAMapOfAnUploadedCloudAndScansIntoIt) {
  ASSERT_EQ(ask(request_for(1, scene_request_t::LOAD, "site")).status, scene_response_t::STATUS_OK);
  const std::string text = "635619.85 848899.7 406.59\n635621.05 848899.7 406.59\n";
  scene_request_t put = request_for(2, scene_request_t::PUT, "site", "survey");
  put.kind = scene_request_t::MESH;
  put.upload_format = "xyz";
  put.cell_m = 0.1;
  put.position_m[2] = 100.0;
  upload(Bytes(text.begin(), text.end()), put);
  const scene_response_t made = ask(put);
  ASSERT_EQ(made.status, scene_response_t::STATUS_OK) << made.message;
  EXPECT_EQ(made.objects[0].kind, "occupancy map");
  EXPECT_EQ(made.scene.num_triangles, 2 * 12);
  EXPECT_EQ(made.objects[0].position_m[0], 0.0);
  EXPECT_NEAR(made.objects[0].bounds_min_m[2], 506.59, 0.1);

  scene_request_t scan = request_for(3, scene_request_t::SCAN, "site", "survey");
  const double seen[] = {635620.45, 848899.75, 506.55};
  scan.position_m[0] = 635620.45;
  scan.position_m[1] = 848899.75;
  scan.position_m[2] = 507.0;
  Bytes bytes(sizeof seen);
  std::memcpy(bytes.data(), seen, sizeof seen);
  upload(bytes, scan);
  const scene_response_t scanned = ask(scan);
  ASSERT_EQ(scanned.status, scene_response_t::STATUS_OK) << scanned.message;
  const auto snapshot = running_.scenes.find("site");
  EXPECT_EQ(snapshot->objects[0]->source->map_O->occupied().size(), 3U);
  EXPECT_TRUE(snapshot->solids->hold({635620.45, 848899.75, 506.55}));
  EXPECT_TRUE(snapshot->solids->hold({635619.85, 848899.7, 506.59}));
  EXPECT_FALSE(snapshot->solids->hold({635620.45, 848899.75, 506.75}));

  put.request_id = 4;
  put.cell_m = -1.0;
  EXPECT_THAT(ask(put).message, HasSubstr("cell_m: must be from 1e-9 to 1e9 m"));
}

/// A daemon that was started anew has the history of durable scenes, but neither answers nor
/// uploads.
TEST_F(SceneServiceTest, MakesAChangeOnceThoughTheUploadIsGoneWithTheDaemonBefore) {
  static_cast<void>(ask(request_for(1, scene_request_t::LOAD, "yard")));
  scene_request_t points = request_for(2, scene_request_t::PUT, "yard", "dust");
  points.kind = scene_request_t::POINTS;
  points.cell_m = 0.5;
  upload(Bytes(48, 0), points);
  const scene_response_t made = ask(points);
  ASSERT_EQ(made.status, scene_response_t::STATUS_OK) << made.message;

  RunningService next;
  ASSERT_TRUE(next.scenes.adopt(*running_.scenes.history("yard")).snapshot);
  Sender sender(next);
  sender.send(points);
  const std::optional<scene_response_t> again = sender.answer_to(points);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->status, scene_response_t::STATUS_OK) << again->message;
  EXPECT_EQ(again->scene.revision, made.scene.revision);
  scene_request_t other = points;
  other.request_id = 3;
  sender.send(other);
  EXPECT_EQ(sender.answer_to(other)->status, scene_response_t::STATUS_INVALID)
      << "another one needs its upload";
}

/// The pages of an exported map are sent as often as their client asks for them.
TEST_F(SceneServiceTest, SendsAnExportedMapPageByPage) {
  scene_request_t load = request_for(1, scene_request_t::LOAD, "yard");
  load.occupancy_resolution_m = 0.1;
  ASSERT_EQ(ask(load).status, scene_response_t::STATUS_OK);
  ASSERT_EQ(ask(put_box(2, "yard", "crate", 20.0)).status, scene_response_t::STATUS_OK);
  const scene_response_t exported = ask(request_for(3, scene_request_t::EXPORT, "yard"));
  ASSERT_EQ(exported.status, scene_response_t::STATUS_OK) << exported.message;
  ASSERT_GT(exported.map_bytes, static_cast<std::int64_t>(wire::kMapPageBytes));

  missing_pages_t wanted{};
  wanted.client_id = "tester";
  wanted.request_id = 3;
  const auto page = [&](std::int32_t number) {
    wanted.missing = {number, number, -1, 1'000'000};
    wanted.num_missing = 4;
    return ask_on<map_page_t>(running_.channels.missing_map_pages(), wire::encode(wanted),
                              running_.channels.map_page("tester"));
  };
  std::vector<std::uint8_t> bytes;
  for (std::int32_t i = 0; i < page(0).num_pages; ++i) {
    const map_page_t got = page(i);
    ASSERT_EQ(got.page, i);
    ASSERT_EQ(got.status, map_page_t::STATUS_OK);
    bytes.insert(bytes.end(), got.bytes.begin(), got.bytes.end());
  }
  EXPECT_EQ(static_cast<std::int64_t>(bytes.size()), exported.map_bytes);
  EXPECT_EQ(wire::crc64(bytes.data(), bytes.size()), exported.map_checksum);
  wanted.request_id = 4;
  EXPECT_EQ(page(0).status, map_page_t::STATUS_INVALID) << "nothing was exported by that id";

  EXPECT_EQ(ask(request_for(5, scene_request_t::EXPORT, "attic")).status,
            scene_response_t::STATUS_UNKNOWN_SCENE);
  ASSERT_EQ(ask(request_for(6, scene_request_t::LOAD, "bare")).status, scene_response_t::STATUS_OK);
  EXPECT_EQ(ask(request_for(7, scene_request_t::EXPORT, "bare")).status,
            scene_response_t::STATUS_NO_MAP);
  scene_request_t to_file = request_for(8, scene_request_t::EXPORT, "yard");
  to_file.file = "yard.bt";
  EXPECT_THAT(ask(to_file).message, HasSubstr("scenes.write_maps is false"));
}

TEST_F(SceneServiceTest, SendsTheTrianglesOfAnObjectInItsFrame) {
  static_cast<void>(ask(request_for(1, scene_request_t::LOAD, "yard")));
  scene_request_t put = put_box(2, "yard", "crate", 2.0);
  put.position_m[0] = 5.0;
  static_cast<void>(ask(put_box(3, "yard", "other", 1.0)));
  const scene_response_t crate = ask(put);
  ASSERT_EQ(crate.status, scene_response_t::STATUS_OK) << crate.message;
  scene_request_t wanted = request_for(4, scene_request_t::TRIANGLES, "yard");
  wanted.digest = crate.objects.at(0).digest;
  const scene_response_t answer = ask(wanted);
  ASSERT_EQ(answer.status, scene_response_t::STATUS_OK) << answer.message;
  EXPECT_EQ(answer.scene.revision, crate.scene.revision) << "nothing was changed";
  ASSERT_EQ(answer.objects.size(), 1U);
  EXPECT_EQ(answer.objects[0].name, "crate");
  EXPECT_EQ(answer.objects[0].position_m[0], 5.0);

  missing_pages_t asked{};
  asked.client_id = wanted.client_id;
  asked.request_id = wanted.request_id;
  asked.missing = {0};
  asked.num_missing = 1;
  const map_page_t page =
      ask_on<map_page_t>(running_.channels.missing_map_pages(), wire::encode(asked),
                         running_.channels.map_page(wanted.client_id));
  EXPECT_EQ(page.num_pages, 1);
  EXPECT_EQ(static_cast<std::int64_t>(page.bytes.size()), answer.map_bytes);
  EXPECT_EQ(wire::crc64(page.bytes.data(), page.bytes.size()), answer.map_checksum);
  const auto mesh = wire::decode_mesh(page.bytes);
  ASSERT_TRUE(mesh);
  const auto yard = running_.scenes.find("yard");
  EXPECT_EQ(mesh->triangles, yard->objects.front()->source->parts_O.front().mesh->triangles);
  EXPECT_EQ(mesh->vertices_m.size(), 8U);
  for (const auto& vertex : mesh->vertices_m) {
    for (const double coordinate : vertex) EXPECT_EQ(std::abs(coordinate), 1.0);
  }
  EXPECT_FALSE(mesh->has_inside);

  wanted.request_id = 5;
  wanted.digest = "none";
  EXPECT_THAT(ask(wanted).message, HasSubstr("digest: is of no object of scene 'yard'"));
  wanted.request_id = 6;
  wanted.scene = "attic";
  EXPECT_EQ(ask(wanted).status, scene_response_t::STATUS_UNKNOWN_SCENE);
  wanted.request_id = 7;
  wanted.object = "crate";
  EXPECT_THAT(ask(wanted).message, HasSubstr("object: does not count"));
}

TEST_F(SceneServiceTest, SendsAMapAsFacesThatHaveAnInside) {
  static_cast<void>(ask(request_for(1, scene_request_t::LOAD, "yard")));
  scene_request_t put = request_for(2, scene_request_t::PUT, "yard", "map");
  put.kind = scene_request_t::MAP;
  put.cell_m = 0.5;
  ASSERT_EQ(ask(put).status, scene_response_t::STATUS_OK);
  scene_request_t scan = request_for(3, scene_request_t::SCAN, "yard", "map");
  const std::array<double, 3> seen{3.2, 0.2, 0.2};
  Bytes bytes(sizeof seen);
  std::memcpy(bytes.data(), seen.data(), sizeof seen);
  upload(bytes, scan);
  const scene_response_t scanned = ask(scan);
  ASSERT_EQ(scanned.status, scene_response_t::STATUS_OK) << scanned.message;
  const auto yard = running_.scenes.find("yard");
  const auto mesh = wire::decode_mesh(sent_mesh(*yard->objects.front()));
  ASSERT_TRUE(mesh);
  EXPECT_TRUE(mesh->has_inside);
  EXPECT_EQ(static_cast<std::int64_t>(mesh->triangles.size()), scanned.scene.num_triangles);
  for (const auto& [x, y, z] : mesh->vertices_m) {
    EXPECT_TRUE(x == 3.0 || x == 3.5) << x;
    EXPECT_TRUE(y == 0.0 || y == 0.5) << y;
    EXPECT_TRUE(z == 0.0 || z == 0.5) << z;
  }
}

TEST_F(SceneServiceTest, SaysWhatIsWrongWithARequest) {
  static_cast<void>(ask(request_for(1, scene_request_t::LOAD, "s")));
  std::int64_t id = 100;
  const auto refusal = [&](scene_request_t request) {
    request.request_id = ++id;
    const scene_response_t answer = ask(request);
    EXPECT_EQ(answer.status, scene_response_t::STATUS_INVALID);
    return answer.message;
  };
  EXPECT_THAT(refusal(request_for(0, 99, "s")), HasSubstr("operation: 99"));
  EXPECT_THAT(refusal(request_for(0, scene_request_t::LOAD, "a/b")), HasSubstr("scene:"));
  EXPECT_THAT(refusal(put_box(0, "s", "")), HasSubstr("object:"));
  EXPECT_THAT(refusal(put_box(0, "s", std::string(65, 'x'))), HasSubstr("object:"));
  EXPECT_THAT(refusal(put_box(0, "s", "crate", -1.0)), HasSubstr("size_m"));
  scene_request_t request = put_box(0, "s", "crate");
  request.kind = 77;
  EXPECT_THAT(refusal(request), HasSubstr("kind: 77"));
  request = put_box(0, "s", "crate");
  request.position_m[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(request), HasSubstr("pose"));
  request = request_for(0, scene_request_t::PUT, "s", "mesh");
  request.file = "a.obj";
  EXPECT_THAT(refusal(request), HasSubstr("no scene roots"));
  request.upload_bytes = 10;
  EXPECT_THAT(refusal(request), HasSubstr("upload"));
  request.scale = -1.0;
  EXPECT_THAT(refusal(request), HasSubstr("scale"));
  request.scale = 1.0;
  request.up = 9;
  EXPECT_THAT(refusal(request), HasSubstr("up: 9"));
  EXPECT_THAT(refusal(request_for(0, scene_request_t::MOVE, "s", "none")), HasSubstr("'none'"));
  request = request_for(0, scene_request_t::PUT, "s", "ball");
  request.kind = scene_request_t::SPHERE;
  EXPECT_THAT(refusal(request), HasSubstr("radius_m"));
  request = put_box(0, "s", "crate");
  request.radius_m = 2.0;
  EXPECT_THAT(refusal(request), HasSubstr("radius_m: does not count"));
  EXPECT_EQ(running_.scenes.find("s")->revision, 1U);
}

TEST_F(SceneServiceTest, TheLogSaysStatusesAsWords) {
  static_cast<void>(ask(request_for(1, scene_request_t::LOAD, "s")));
  static_cast<void>(ask(request_for(2, scene_request_t::MOVE, "none", "chair")));
  static_cast<void>(ask(request_for(3, scene_request_t::EXPORT, "s")));
  EXPECT_THAT(running_.log_text(), HasSubstr("status=ok "));
  EXPECT_THAT(running_.log_text(), HasSubstr("status=unknown_scene "));
  EXPECT_THAT(running_.log_text(), HasSubstr("status=no_map "));
}

TEST_F(SceneServiceTest, ListsAndRestoresRevisions) {
  const std::string first = ask(request_for(1, scene_request_t::LOAD, "s")).scene.digest;
  const std::string second = ask(put_box(2, "s", "crate")).scene.digest;
  scene_request_t move = request_for(3, scene_request_t::MOVE, "s", "crate");
  move.position_m[0] = 5.0;
  ASSERT_EQ(ask(move).status, scene_response_t::STATUS_OK);
  scene_request_t restore = request_for(4, scene_request_t::RESTORE, "s");
  restore.revision = 2;
  const scene_response_t restored = ask(restore);
  ASSERT_EQ(restored.status, scene_response_t::STATUS_OK) << restored.message;
  EXPECT_EQ(restored.scene.revision, 4);
  EXPECT_EQ(restored.scene.digest, second);
  EXPECT_EQ(wire::encode(ask(restore)), wire::encode(restored)) << "done once";

  const scene_response_t history = ask(request_for(5, scene_request_t::HISTORY, "s"));
  ASSERT_EQ(history.num_changes, 4) << history.message;
  EXPECT_EQ(history.total, 4);
  EXPECT_EQ(history.scene.revision, 4);
  const std::vector<std::string> operations{"load", "put", "move", "restore"};
  for (std::size_t i = 0; i < operations.size(); ++i) {
    const scene_change_t& change = history.changes[i];
    EXPECT_EQ(change.operation, operations[i]);
    EXPECT_EQ(change.object, i == 1 || i == 2 ? "crate" : "");
    EXPECT_EQ(change.client_id, "tester");
    EXPECT_EQ(change.revision, static_cast<std::int64_t>(i) + 1);
    EXPECT_EQ(change.restored_revision, i == 3 ? 2 : 0);
    EXPECT_GT(change.utime, 0);
  }
  scene_request_t from_third = request_for(6, scene_request_t::HISTORY, "s");
  from_third.first = 2;
  EXPECT_EQ(ask(from_third).changes.front().operation, "move");

  scene_request_t as_copy = request_for(7, scene_request_t::RESTORE, "s");
  as_copy.revision = 1;
  as_copy.restore_as = "copy";
  const scene_response_t copy = ask(as_copy);
  EXPECT_EQ(copy.scene.name, "copy");
  EXPECT_EQ(copy.scene.digest, first);

  scene_request_t as_itself = request_for(10, scene_request_t::RESTORE, "s");
  as_itself.revision = 3;
  as_itself.restore_as = "s";
  EXPECT_EQ(ask(as_itself).scene.revision, 5);
  EXPECT_EQ(ask(request_for(11, scene_request_t::HISTORY, "s")).total, 5) << "nothing is forgotten";

  restore.request_id = 8;
  restore.revision = -1;
  EXPECT_THAT(ask(restore).message, HasSubstr("1 to 5 are"));
  as_copy.request_id = 9;
  as_copy.restore_as = "a/b";
  EXPECT_THAT(ask(as_copy).message, HasSubstr("restore_as:"));
  EXPECT_EQ(ask(request_for(10, scene_request_t::HISTORY, "none")).status,
            scene_response_t::STATUS_UNKNOWN_SCENE);
}

// The bounds of a scene stay through all changes and restorations.
TEST_F(SceneServiceTest, KeepsTheBoundsOfAScene) {
  scene_request_t load = request_for(1, scene_request_t::LOAD, "s");
  load.body_bounds.has_min[1] = 1;
  load.body_bounds.min_m[1] = -0.5;
  const auto has_bounds = [](const scene_info_t& scene) {
    return scene.body_bounds.has_min[1] == 1 && scene.body_bounds.min_m[1] == -0.5 &&
           scene.body_bounds.has_max[1] == 0;
  };
  const scene_response_t loaded = ask(load);
  ASSERT_EQ(loaded.status, scene_response_t::STATUS_OK) << loaded.message;
  EXPECT_TRUE(has_bounds(loaded.scene));
  EXPECT_TRUE(has_bounds(ask(put_box(2, "s", "crate")).scene));
  scene_request_t restore = request_for(3, scene_request_t::RESTORE, "s");
  restore.revision = 1;
  EXPECT_TRUE(has_bounds(ask(restore).scene));
  restore.request_id = 4;
  restore.restore_as = "copy";
  EXPECT_TRUE(has_bounds(ask(restore).scene));
  EXPECT_TRUE(has_bounds(ask(request_for(5, scene_request_t::DESCRIBE, "copy")).scene));
  EXPECT_EQ(ask(request_for(6, scene_request_t::LOAD, "s")).scene.body_bounds.has_min[1], 0)
      << "a new scene of that name has its own";
  load.request_id = 7;
  load.body_bounds.has_max[1] = 1;
  load.body_bounds.max_m[1] = -1.0;
  EXPECT_THAT(ask(load).message, HasSubstr("body_bounds.min[1]: is not below max[1]"));
}

TEST_F(SceneServiceTest, AnswersWhatItCannotRead) {
  Bytes bytes = wire::encode(put_box(5, "s", "crate"));
  bytes.pop_back();
  const scene_response_t answer = ask_on<scene_response_t>(
      running_.channels.scene_request(), bytes, running_.channels.scene_response("tester"));
  EXPECT_EQ(answer.status, scene_response_t::STATUS_MALFORMED);
  EXPECT_EQ(answer.request_id, 5);
}

TEST_F(SceneServiceTest, PlanningKeepsTheSceneItBeganWith) {
  static_cast<void>(ask(request_for(1, scene_request_t::LOAD, "s")));
  running_.planner.hold();
  plan_request_t plan = testing::request_with(9);
  plan.scene = "s";
  running_.send(plan);
  ASSERT_TRUE(running_.planner.wait_for_calls(1));
  ASSERT_EQ(ask(put_box(2, "s", "crate")).scene.revision, 2);
  running_.planner.release();
  const auto answer = running_.answer_to(plan);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->scene_revision, 1);
}

TEST(SceneServiceLimits, OneExportAloneMayBeTooLarge) {
  ServiceConfig config;
  config.exports.bytes = 1000;
  RunningService running(config);
  Sender sender(running);
  scene_request_t load = request_for(1, scene_request_t::LOAD, "yard");
  load.occupancy_resolution_m = 0.1;
  scene_request_t exported = request_for(3, scene_request_t::EXPORT, "yard");
  for (const scene_request_t& request : {load, put_box(2, "yard", "crate", 5.0), exported}) {
    sender.send(request);
  }
  const auto answer = sender.answer_to(exported);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, scene_response_t::STATUS_LIMIT);
  EXPECT_THAT(answer->message, HasSubstr("scenes.all_exports_bytes"));
  EXPECT_EQ(answer->map_bytes, 0);
}

}  // namespace
}  // namespace camway::service
