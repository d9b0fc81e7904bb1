// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "daemon/scene/mirror/scene_mirror.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "lcmtypes/wire/checksum.h"
#include "tests/service/running_service.h"

namespace camway::service {
namespace {

using ::testing::HasSubstr;
using testing::RunningService;

ServiceConfig tight_rules() {
  ServiceConfig config;
  config.scene_rules.mirror_voxels = 1000;
  config.scene_rules.scan_voxels = 1000;
  config.scene_rules.maps.voxels = 50;
  config.scene_rules.maps.triangles = 12;
  return config;
}

constexpr double kCell_m = 0.5;

/// Returns the size of the mirror of a box at the origin.
std::uint64_t mirror_bytes(double side_m) {
  const auto box = scene::box_mesh(geometry::Vec3::Constant(side_m));
  return scene::ObjectMirror::build(*box, kCell_m).map->statistics().memory_bytes;
}

scene::SceneStoreLimits tight_store() {
  scene::SceneStoreLimits limits;
  limits.scenes = 3;  // with the two that are always there
  limits.objects = 3;
  limits.triangles = 200;
  limits.occupancy_bytes = 3 * mirror_bytes(1.0);
  return limits;
}

/// A scene "s" with a mirror of voxels of `kCell_m`, in a daemon with small limits.
class SceneLimits : public ::testing::Test {
 protected:
  SceneLimits() {
    scene_request_t load = request_for(scene_request_t::LOAD, "s");
    load.occupancy_resolution_m = kCell_m;
    expect_ok(load);
  }

  static scene_request_t request_for(std::int8_t operation, const std::string& scene,
                                     const std::string& object = "") {
    scene_request_t request{};
    request.client_id = "tester";
    request.operation = operation;
    request.scene = scene;
    request.object = object;
    return request;
  }

  static scene_request_t put_box(const std::string& object, double side_m) {
    scene_request_t request = request_for(scene_request_t::PUT, "s", object);
    request.kind = scene_request_t::BOX;
    for (double& side : request.size_m) side = side_m;
    return request;
  }

  static scene_request_t put_map(const std::string& object, double cell_m) {
    scene_request_t request = request_for(scene_request_t::PUT, "s", object);
    request.kind = scene_request_t::MAP;
    request.cell_m = cell_m;
    return request;
  }

  /// Sends the scan of a sensor at the origin.
  scene_request_t scan(const std::string& object, const std::vector<double>& points_m) {
    scene_request_t request = request_for(scene_request_t::SCAN, "s", object);
    Bytes bytes(points_m.size() * sizeof(double));
    std::memcpy(bytes.data(), points_m.data(), bytes.size());
    upload(bytes, request);
    return request;
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
    const std::string answers = running_.channels.upload_status(page.client_id);
    const std::size_t before = running_.transport.published_on(answers).size();
    running_.send_on(running_.channels.upload(), wire::encode(page));
    ASSERT_TRUE(running_.transport.message_on(answers, before));
  }

  scene_response_t ask(scene_request_t request) {
    request.request_id = ++id_;
    const std::string answers = running_.channels.scene_response(request.client_id);
    const std::size_t before = running_.transport.published_on(answers).size();
    running_.send_on(running_.channels.scene_request(), wire::encode(request));
    const auto bytes = running_.transport.message_on(answers, before);
    return bytes ? wire::decode<scene_response_t>(*bytes).message.value_or(scene_response_t{})
                 : scene_response_t{};
  }

  void expect_ok(const scene_request_t& request) {
    const scene_response_t answer = ask(request);
    EXPECT_EQ(answer.status, scene_response_t::STATUS_OK) << answer.message;
  }

  void expect_limit(const scene_request_t& request, const std::string& setting) {
    const scene_response_t answer = ask(request);
    EXPECT_EQ(answer.status, scene_response_t::STATUS_LIMIT) << setting << ": " << answer.message;
    EXPECT_THAT(answer.message, HasSubstr("(" + setting + ")"));
  }

  RunningService running_{tight_rules(), testing::echo_result, {}, tight_store()};
  std::int64_t id_ = 0;
};

TEST_F(SceneLimits, OfTheStoreNameTheirSettings) {
  expect_limit(request_for(scene_request_t::LOAD, "t"), "scenes.scenes");
  for (const char* name : {"a", "b", "c"}) expect_ok(put_box(name, 1.0));
  expect_limit(put_box("d", 1.0), "scenes.objects");
  ASSERT_GT(mirror_bytes(4.0), mirror_bytes(1.0));
  expect_limit(put_box("a", 4.0), "scenes.occupancy_bytes");
  scene_request_t ball = request_for(scene_request_t::PUT, "s", "a");
  ball.kind = scene_request_t::SPHERE;
  ball.radius_m = 0.5;
  ball.chord_error_m = 0.001;
  expect_limit(ball, "scenes.triangles");
  EXPECT_EQ(running_.scenes.find("s")->revision, 4U) << "what was refused changed nothing";
}

TEST_F(SceneLimits, OfMirrorsNameTheirSetting) {
  expect_limit(put_box("large", 100.0), "scenes.mirror_voxels");
  expect_ok(put_box("small", 1.0));
  // The same if a scene is loaded with a mirror.
  const std::string text = "v 0 0 0\nv 90 0 0\nv 0 90 0\nf 1 2 3\n";
  scene_request_t load = request_for(scene_request_t::LOAD, "s");
  load.occupancy_resolution_m = kCell_m;
  load.upload_format = "obj";
  upload(Bytes(text.begin(), text.end()), load);
  expect_limit(load, "scenes.mirror_voxels");
}

TEST_F(SceneLimits, OfMapsAndScansNameTheirSettings) {
  expect_ok(put_map("seen", 0.1));
  expect_limit(scan("seen", {0.05, 0.05, 200.05}), "scenes.scan_voxels");
  expect_limit(scan("seen", {0.05, 0.05, 10.05}), "scenes.map_voxels");
  expect_limit(scan("seen", {0.05, 0.05, 0.55, 0.05, 0.55, 0.05}), "scenes.map_triangles");
  expect_ok(scan("seen", {0.05, 0.05, 0.55}));
}

TEST_F(SceneLimits, OfMapsThatAreReadNameTheirSetting) {
  expect_ok(put_box("crate", 3.0));
  std::ostringstream map;
  running_.scenes.find("s")->occupancy->write_bt(map);
  const std::string bytes = map.str();
  scene_request_t load = request_for(scene_request_t::LOAD, "s");
  load.upload_format = "bt";
  upload(Bytes(bytes.begin(), bytes.end()), load);
  expect_limit(load, "scenes.map_voxels");
}

}  // namespace
}  // namespace camway::service
