// SPDX-License-Identifier: MIT
#include <camway/client.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>
#include <thread>
#include <vector>

#include <camway/scene_response_t.hpp>

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

}  // namespace
}  // namespace camway
