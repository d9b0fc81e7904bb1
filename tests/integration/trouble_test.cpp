// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <camway/error_t.hpp>
#include <camway/occupancy_request_t.hpp>
#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>
#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/wire/channels.h"
#include "lcmtypes/wire/check.h"
#include "tests/integration/fixture.h"
#include "tests/support/random.h"

namespace camway::integration {
namespace {

using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

/// A program on the network that sends arbitrary bytes and receives the answers.
class Stranger {
 public:
  Stranger() {
    lcm_.subscribeFunction(channels_.error(), &Stranger::take_error, this);
    lcm_.subscribeFunction(channels_.plan_response("stranger"), &Stranger::take_answer, this);
  }

  void send(const std::string& channel, const Bytes& bytes) {
    lcm_.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
  }
  void send_plan(const Bytes& bytes) { send(channels_.plan_request(), bytes); }
  void send_occupancy(const Bytes& bytes) { send(channels_.occupancy_request(), bytes); }

  /// Handles the messages that have come.
  void listen() {
    while (lcm_.handleTimeout(1) > 0) {
    }
  }

  std::vector<error_t> errors;
  std::vector<plan_response_t> answers;

 private:
  template <class Message>
  static void take(const lcm::ReceiveBuffer* buffer, std::vector<Message>& list) {
    auto decoded =
        wire::decode<Message>({static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
    ASSERT_TRUE(decoded.message) << "the daemon sent what cannot be read";
    list.push_back(*decoded.message);
  }
  static void take_error(const lcm::ReceiveBuffer* buffer, const std::string&, Stranger* self) {
    take(buffer, self->errors);
  }
  static void take_answer(const lcm::ReceiveBuffer* buffer, const std::string&, Stranger* self) {
    take(buffer, self->answers);
  }

  wire::Channels channels_;
  lcm::LCM lcm_;
};

plan_request_t good_request() {
  plan_request_t request{};
  request.client_id = "stranger";
  request.request_id = 5;
  request.num_pages = 1;
  request.scene = "office";
  return request;
}

/// The count of keyframes is the end of a request without keyframes.
Bytes with_keyframe_count(std::int32_t count) {
  Bytes bytes = wire::encode(good_request());
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[bytes.size() - 4 + i] =
        static_cast<std::uint8_t>(static_cast<std::uint32_t>(count) >> (24 - 8 * i));
  }
  return bytes;
}

class TroubleTest : public IntegrationTest {
 protected:
  void expect_daemon_works() {
    ASSERT_TRUE(daemon().running()) << daemon().output();
    Client client(patient());
    const PlanResponse response = client.plan(request_of("office-free-door", "office"));
    EXPECT_TRUE(response.ok()) << response.error;
  }
};

TEST_F(TroubleTest, MalformedMessagesAreAnsweredAndCounted) {
  start_daemon();
  Stranger stranger;
  // If the sender can be read, the answer comes on its channel.
  for (const std::int32_t count : {-1, 1, 200'000'000, std::numeric_limits<std::int32_t>::max()}) {
    const std::size_t before = stranger.answers.size();
    stranger.send_plan(with_keyframe_count(count));
    ASSERT_TRUE(eventually([&] {
      stranger.listen();
      return stranger.answers.size() > before;
    })) << count;
    EXPECT_EQ(stranger.answers.back().status, plan_response_t::STATUS_MALFORMED);
    EXPECT_EQ(stranger.answers.back().request_id, 5);
    EXPECT_THAT(stranger.answers.back().message, HasSubstr("keyframes"));
  }
  // If not, an error goes to all.
  stranger.send_plan(Bytes(76, 0xff));
  ASSERT_TRUE(eventually([&] {
    stranger.listen();
    return !stranger.errors.empty();
  }));
  EXPECT_EQ(stranger.errors.back().channel, "CAMWAY_PLAN_REQUEST");
  EXPECT_EQ(stranger.errors.back().size_bytes, 76);
  Client client;
  EXPECT_TRUE(eventually([&] { return client.status().malformed_messages >= 5; }));
  expect_daemon_works();
}

TEST_F(TroubleTest, RandomBytesDoNotHurt) {
  constexpr std::uint32_t kSeed = 20061121;
  start_daemon();
  testing::Random random(kSeed);
  Stranger stranger;
  const Bytes plan = wire::encode(good_request());
  const Bytes occupancy = wire::encode(occupancy_request_t{});
  for (int i = 0; i < 2000; ++i) {
    Bytes bytes = i % 2 == 0 ? plan : occupancy;
    for (int flips = 0; flips <= i % 5; ++flips) {
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    }
    if (i % 7 == 0) bytes.resize(random() % bytes.size());
    if (i % 2 == 0) {
      stranger.send_plan(bytes);
    } else {
      stranger.send_occupancy(bytes);
    }
    if (i % 50 == 0) stranger.listen();
  }
  expect_daemon_works();
}

TEST_F(TroubleTest, UnknownSceneIsNamed) {
  start_daemon();
  Client client(patient());
  const PlanResponse response = client.plan(request_of("office-free-door", "castle"));
  EXPECT_EQ(response.status, Status::kUnknownScene);
  EXPECT_THAT(response.error, HasSubstr("castle"));
  OccupancyBatch batch;
  batch.scene = "castle";
  batch.points_m.push_back({0, 0, 0});
  EXPECT_EQ(client.occupancy(batch).status, Status::kUnknownScene);
  expect_daemon_works();
}

TEST_F(TroubleTest, BadKeyframesAreNamed) {
  start_daemon();
  Client client(patient());
  const auto expect_invalid = [&](auto damage, const std::string& text) {
    PlanRequest request = request_of("office-free-timed", "office");
    damage(request);
    const PlanResponse response = client.plan(request);
    EXPECT_EQ(response.status, Status::kInvalid) << text;
    EXPECT_THAT(response.error, HasSubstr(text));
    EXPECT_TRUE(response.path.empty());
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_invalid([](auto& r) { r.keyframes[2].orientation_wxyz = {0, 0, 0, 0}; }, "keyframes[2]");
  expect_invalid([&](auto& r) { r.keyframes[1].position_m[1] = nan; }, "keyframes[1]");
  expect_invalid([](auto& r) { r.keyframes[3].time_s = r.keyframes[0].time_s; }, "keyframes[3]");
  expect_invalid([](auto& r) { r.keyframes.resize(1); }, "keyframes");
  expect_invalid([](auto& r) { r.keyframes.clear(); }, "keyframes");
  expect_invalid([](auto& r) { r.camera.near_m = -1; }, "near");
  expect_invalid([](auto& r) { r.method = "wishing"; }, "wishing");
  expect_invalid([](auto& r) { r.orientation.cone_rad = 4.0; }, "orientation.cone");
  expect_invalid([&](auto& r) { r.orientation.max_turn_rad = nan; }, "orientation.max_turn");
  expect_invalid([](auto& r) { r.limits.speed_m_per_s = -1.0; }, "limits.speed");
  expect_invalid([](auto& r) { r.max_shrink = 1.0; }, "max_shrink");
  expect_daemon_works();
}

TEST_F(TroubleTest, AKeyframeInsideAWallIsNamed) {
  // A camera whose near quadrilateral intersects a wall, the plane x = 0.
  {
    std::ofstream scene(file("wall.obj"));
    scene << "v 0 -5 -5\nv 0 5 -5\nv 0 5 5\nv 0 -5 5\nf 1 2 3 4\n";
  }
  start_daemon_with_scenes({"wall=" + file("wall.obj")});
  Client client(patient());
  PlanRequest request;
  request.scene = "wall";
  request.keyframes.resize(3);
  request.keyframes[0].position_m = {-2, 0, 0};
  request.keyframes[1].position_m = {0.01, 0, 0};
  request.keyframes[2].position_m = {2, 0, 0};
  const PlanResponse response = client.plan(request);
  EXPECT_EQ(response.status, Status::kInvalid);
  EXPECT_EQ(response.keyframe, 1);
  EXPECT_THAT(response.error, HasSubstr("keyframes[1]"));
}

TEST_F(TroubleTest, ABrokenSceneFileEndsTheStart) {
  {
    std::ofstream scene(file("broken.obj"));
    scene << "this is not a scene\n";
  }
  for (const std::string& path : {file("broken.obj"), file("missing.obj")}) {
    Process daemon({CAMWAYD_BINARY, "--scene", "x=" + path}, file("broken.log"));
    EXPECT_EQ(daemon.wait(), 2) << daemon.output();
    EXPECT_THAT(daemon.output(), HasSubstr(path));
  }
}

}  // namespace
}  // namespace camway::integration
