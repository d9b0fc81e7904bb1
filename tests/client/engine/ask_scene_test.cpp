// SPDX-License-Identifier: MIT
#include <camway/client.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include <camway/map_page_t.hpp>
#include <camway/scene_response_t.hpp>

#include "lcmtypes/wire/checksum.h"
#include "lcmtypes/wire/layout.h"
#include "lcmtypes/wire/object_mesh.h"
#include "tests/client/client_fixture.h"
#include "tests/client/fake_daemon.h"

namespace camway {
namespace {

using ::testing::HasSubstr;
using testing_support::Bytes;
using testing_support::FakeDaemon;
using testing_support::quick;

using AskSceneTest = testing_support::ClientTest;

template <class Message>
std::vector<Bytes> answer(const Message& asked, std::int32_t status) {
  scene_response_t response{};
  response.client_id = asked.client_id;
  response.request_id = asked.request_id;
  response.status = status;
  response.message = "so it is";
  return {wire::encode(response)};
}

TEST_F(AskSceneTest, SaysHowLongAChangeMayTake) {
  std::atomic<double> deadline_s = -1.0;
  FakeDaemon daemon;
  daemon.on_scene = [&](const scene_request_t& request) {
    deadline_s = request.deadline_s;
    return answer(request, scene_response_t::STATUS_TIMEOUT);
  };
  daemon.start();
  ClientOptions options = quick();
  options.change_deadline_s = 2.5;
  Client client(options);
  const SceneAnswer late = client.remove_object("room", "crate");
  EXPECT_EQ(late.status, Status::kTimeout);
  EXPECT_THAT(late.error, HasSubstr("so it is"));
  EXPECT_EQ(deadline_s, 2.5);
  for (const double none_s : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    options.change_deadline_s = none_s;
    EXPECT_THAT(Client(options).error(), HasSubstr("change_deadline_s"));
  }
}

/// Cancels as soon as `request` has arrived, and returns the answer.
SceneAnswer called_off(Client& client, const std::atomic<std::int64_t>& request) {
  const std::jthread other([&] {
    while (request == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    client.cancel_scene_calls();
  });
  return client.remove_object("room", "crate");
}

TEST_F(AskSceneTest, CallsOffAChangeThatTheDaemonIsAt) {
  std::atomic<bool> is_lost = true;  // the first cancel is, so another comes
  std::atomic<std::int64_t> asked = 0;
  FakeDaemon daemon;
  daemon.on_scene = [&](const scene_request_t& request) {
    asked = request.request_id;
    return std::vector<Bytes>{};
  };
  daemon.on_cancel_scene = [&](const cancel_t& cancel) {
    EXPECT_EQ(cancel.request_id, asked);
    if (is_lost.exchange(false)) return std::vector<Bytes>{};
    return answer(cancel, scene_response_t::STATUS_CANCELLED);
  };
  daemon.start();
  Client client(quick());
  EXPECT_EQ(called_off(client, asked).status, Status::kCancelled);
  EXPECT_FALSE(is_lost);
}

TEST_F(AskSceneTest, AChangeThatIsInForceKeepsItsAnswer) {
  std::atomic<std::int64_t> asked = 0;
  FakeDaemon daemon;
  daemon.on_scene = [&](const scene_request_t& request) {
    asked = request.request_id;
    return std::vector<Bytes>{};
  };
  daemon.on_cancel_scene = [&](const cancel_t& cancel) {
    return answer(cancel, scene_response_t::STATUS_OK);
  };
  daemon.start();
  Client client(quick());
  EXPECT_TRUE(called_off(client, asked).ok());
}

TEST_F(AskSceneTest, WaitsNotLongForADaemonThatSaysNothingOfACancel) {
  std::atomic<std::int64_t> asked = 0;
  FakeDaemon daemon;
  daemon.heartbeat_every = std::chrono::milliseconds(20);
  daemon.on_scene = [&](const scene_request_t& request) {
    asked = request.request_id;
    return std::vector<Bytes>{};
  };
  daemon.start();
  ClientOptions options = quick();
  options.deadline_s = 60.0;
  Client client(options);
  const auto begin = std::chrono::steady_clock::now();
  const SceneAnswer answer = called_off(client, asked);
  EXPECT_EQ(answer.status, Status::kNoAnswer);
  EXPECT_THAT(answer.error, HasSubstr("no daemon says what became of it"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST_F(AskSceneTest, CallsOffAnUploadAndNothingThatIsAskedLater) {
  std::atomic<int> asked = 0;
  FakeDaemon daemon;  // it says nothing of uploads
  daemon.heartbeat_every = std::chrono::milliseconds(20);
  daemon.on_scene = [&](const scene_request_t& request) {
    ++asked;
    return answer(request, scene_response_t::STATUS_OK);
  };
  daemon.start();
  Client client(quick());
  SceneMesh mesh;
  mesh.bytes = {1, 2, 3};
  mesh.format = "obj";
  std::atomic<bool> is_over = false;
  std::jthread other([&] {
    while (!is_over) {
      client.cancel_scene_calls();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  EXPECT_EQ(client.load_scene("room", mesh).status, Status::kCancelled);
  is_over = true;
  other.join();
  EXPECT_EQ(asked, 0);
  EXPECT_TRUE(client.remove_object("room", "crate").ok());
}

/// A daemon with an object of many triangles, whose pages get lost.
class TrianglesTest : public AskSceneTest {
 protected:
  TrianglesTest() {
    constexpr std::uint32_t kVertices = 10'000;
    for (std::uint32_t i = 0; i < kVertices; ++i) mesh_.vertices_m.push_back({1.0 * i, 0.5, -1.0});
    for (std::uint32_t i = 0; i + 2 < kVertices; ++i) mesh_.triangles.push_back({i, i + 1, i + 2});
    mesh_.parts = {{"floor", kVertices - 12}, {"lamp", 10}};
    mesh_.surface_error_m = 0.125;
    bytes_ = wire::encode_mesh(mesh_);
    daemon_.on_scene = [this](const scene_request_t& request) { return exported(request); };
    daemon_.on_missing_map = [this](const missing_pages_t& asked) { return pages(asked); };
  }
  ~TrianglesTest() override { daemon_.stop(); }

  std::vector<Bytes> exported(const scene_request_t& request) {
    EXPECT_EQ(request.operation, scene_request_t::TRIANGLES);
    EXPECT_EQ(request.digest, "d1");
    scene_response_t response{};
    response.client_id = request.client_id;
    response.request_id = request.request_id;
    response.scene.name = request.scene;
    response.scene.revision = 7;
    response.num_objects = 1;
    response.objects.resize(1);
    response.objects[0].name = "desk";
    response.map_bytes = static_cast<std::int64_t>(bytes_.size());
    response.map_checksum = wire::crc64(bytes_.data(), bytes_.size());
    return {wire::encode(response)};
  }
  /// Every page is lost once, and is damaged the next time.
  std::vector<Bytes> pages(const missing_pages_t& asked) {
    std::vector<Bytes> sent;
    for (const std::int32_t number : asked.missing) {
      const int time = ++times_[number];
      if (time == 1) continue;
      map_page_t page{};
      page.client_id = asked.client_id;
      page.request_id = asked.request_id;
      page.page = number;
      page.num_pages = static_cast<std::int32_t>((bytes_.size() + wire::kMapPageBytes - 1) /
                                                 wire::kMapPageBytes);
      const std::size_t begin = static_cast<std::size_t>(number) * wire::kMapPageBytes;
      const std::size_t end = std::min(bytes_.size(), begin + wire::kMapPageBytes);
      page.bytes.assign(bytes_.begin() + static_cast<std::ptrdiff_t>(begin),
                        bytes_.begin() + static_cast<std::ptrdiff_t>(end));
      page.num_bytes = static_cast<std::int32_t>(page.bytes.size());
      page.page_checksum = wire::crc64(page.bytes.data(), page.bytes.size());
      if (time == 2) page.bytes[0] ^= 1;
      sent.push_back(wire::encode(page));
    }
    return sent;
  }

  wire::ObjectMesh mesh_;
  Bytes bytes_;
  std::map<std::int32_t, int> times_;  ///< how often each page was asked for
  FakeDaemon daemon_;
};

TEST_F(TrianglesTest, ComeThroughLossesAndDamage) {
  daemon_.start();
  Client client(quick());
  const SceneTriangles got = client.object_triangles("room", "d1");
  ASSERT_TRUE(got.ok()) << got.error;
  EXPECT_EQ(got.scene.revision, 7);
  EXPECT_EQ(got.object.name, "desk");
  EXPECT_EQ(got.vertices_m, mesh_.vertices_m);
  EXPECT_EQ(got.triangles, mesh_.triangles);
  ASSERT_EQ(got.parts.size(), 2U);
  EXPECT_EQ(got.parts[1].name, "lamp");
  EXPECT_EQ(got.parts[1].num_triangles, 10U);
  EXPECT_EQ(got.surface_error_m, 0.125);
  EXPECT_FALSE(got.has_inside);
  daemon_.stop();
  EXPECT_GT(times_.size(), 7U);
  for (const auto& [number, times] : times_) EXPECT_GE(times, 3) << number;
}

TEST_F(TrianglesTest, BytesThatAreNoMeshAreABadAnswer) {
  bytes_.pop_back();
  daemon_.start();
  Client client(quick());
  const SceneTriangles got = client.object_triangles("room", "d1");
  EXPECT_EQ(got.status, Status::kBadAnswer);
  EXPECT_THAT(got.error, HasSubstr("cannot be read"));
}

TEST_F(TrianglesTest, ADigestThatIsTooLongIsNotSent) {
  daemon_.start();
  Client client(quick());
  EXPECT_EQ(client.object_triangles("room", std::string(1000, 'x')).status, Status::kInvalid);
}

}  // namespace
}  // namespace camway
