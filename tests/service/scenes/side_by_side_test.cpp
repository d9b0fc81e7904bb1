// SPDX-License-Identifier: MIT
//
// Changes of scenes that are made at the same time, and the end of the service meanwhile.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <latch>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/service/scenes/scene_service.h"
#include "tests/service/running_service.h"
#include "tests/service/scenes/scene_sender.h"
#include "tests/support/slow_mesh.h"
#include "tests/support/temporary_folder.h"

namespace camway::service {
namespace {

using ::testing::HasSubstr;
using testing::RunningService;
using testing_scenes::put_box;
using testing_scenes::request_for;
using testing_scenes::Sender;
using testing_scenes::with_root;

TEST(SceneServiceSideBySide, ImportsOfOneClientHoldUpNeitherOtherScenesNorOtherClients) {
  const testing::TemporaryFolder folder;
  testing::write_slow_mesh((folder.path() / "slow.obj").string());
  RunningService running(with_root(folder, 2));
  Sender sender(running);
  for (int i = 0; i < 10; ++i) {
    scene_request_t load = request_for(i, scene_request_t::LOAD, "slow" + std::to_string(i));
    load.client_id = "importer";
    load.file = "slow.obj";
    sender.send(load);
  }
  // Several changes, because a worker may take the first of them before it takes an import.
  for (int i = 1; i <= 5; ++i) {
    const scene_request_t put = put_box(i, "room", "crate");
    sender.send(put);
    const auto answer = sender.answer_to(put);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, scene_response_t::STATUS_OK) << answer->message;
  }
  scene_request_t list = request_for(20, scene_request_t::LIST, "");
  list.client_id = "importer";
  sender.send(list);
  ASSERT_TRUE(sender.answer_to(list)) << "who only looks waits for no change";
  EXPECT_EQ(sender.answers("importer"), 1U) << "the imports still run or wait";
}

TEST(SceneServiceSideBySide, AStopCallsOffImportsAndSaysSo) {
  const testing::TemporaryFolder folder;
  testing::write_slow_mesh((folder.path() / "slow.obj").string());
  RunningService running(with_root(folder, 3));
  Sender sender(running);
  std::vector<scene_request_t> loads;
  for (int i = 0; i < 3; ++i) {
    loads.push_back(request_for(i, scene_request_t::LOAD, "slow" + std::to_string(i)));
    loads.back().file = "slow.obj";
    sender.send(loads.back());
  }
  scene_request_t put = put_box(9, "room", "crate");
  put.client_id = "mover";
  sender.send(put);
  ASSERT_TRUE(sender.answer_to(put)) << "so two of the others have begun, and one waits";
  EXPECT_EQ(running.stop(), RunOutcome::kDrained) << "within the drain limit";
  for (const scene_request_t& load : loads) {
    const auto answer = sender.answer_to(load);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, scene_response_t::STATUS_STOPPING);
    EXPECT_THAT(answer->message, HasSubstr("the daemon is stopping"));
    EXPECT_EQ(running.scenes.find(load.scene), nullptr);
  }
}

TEST(SceneServiceSideBySide, AStopCallsOffTheMakingOfAMirror) {
  ServiceConfig config;
  config.scene_rules.mirror_voxels = 1'000'000'000;
  RunningService running(config);
  Sender sender(running);
  scene_request_t load = request_for(1, scene_request_t::LOAD, "fine");
  load.occupancy_resolution_m = 0.002;
  sender.send(load);
  ASSERT_TRUE(sender.answer_to(load));
  const scene_request_t large = put_box(2, "fine", "hangar", 14.0);  // minutes
  sender.send(large);
  scene_request_t other = put_box(3, "room", "crate");
  other.client_id = "other";
  sender.send(other);
  ASSERT_TRUE(sender.answer_to(other)) << "so the hangar is being made";
  running.stop();  // else the end of `running` waits for those minutes
  const auto answer = sender.answer_to(large);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, scene_response_t::STATUS_STOPPING);
  EXPECT_TRUE(running.scenes.find("fine")->objects.empty());
}

TEST(SceneServiceSideBySide, AStopSaysThatAChangeMayHaveBeenMade) {
  ServiceConfig config;
  config.drain_limit = std::chrono::milliseconds(100);
  RunningService running(config);
  Sender sender(running);
  std::latch entered(1);
  std::latch done(1);
  running.scenes.on_change([&] {
    entered.count_down();
    done.wait();
  });
  const scene_request_t put = put_box(1, "room", "crate");
  sender.send(put);
  entered.wait();
  EXPECT_EQ(running.stop(), RunOutcome::kAbandoned);
  const auto answer = sender.answer_to(put);
  done.count_down();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, scene_response_t::STATUS_INTERNAL_ERROR) << "it is committed";
  EXPECT_THAT(answer->message, HasSubstr("to know whether it was made"));
}

TEST(SceneServiceSideBySide, AStopWaitsForAChangeThatIsBeingKept) {
  RunningService running;
  Sender sender(running);
  std::latch entered(1);
  running.scenes.on_change([&] {
    entered.count_down();
    // Longer than a stop waits for cancelled changes.
    std::this_thread::sleep_for(std::chrono::seconds(1));
  });
  const scene_request_t put = put_box(1, "room", "crate");
  sender.send(put);
  entered.wait();
  EXPECT_EQ(running.stop(), RunOutcome::kDrained);
  const auto answer = sender.answer_to(put);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, scene_response_t::STATUS_OK) << answer->message;
}

TEST(SceneServiceSideBySide, OfAClientTheChangesOfASceneStayInOrder) {
  constexpr int kClients = 8;
  constexpr int kMoves = 30;
  RunningService running;
  const std::uint64_t hall = running.scenes.find("hall")->revision;
  const std::uint64_t room = running.scenes.find("room")->revision;
  Sender sender(running);
  const auto change = [](int client, int i) {
    const std::string scene = i % 3 == 0 ? "hall" : "room";
    const std::string object = "crate" + std::to_string(client);
    scene_request_t request = put_box(i, scene, object, 1.0 + i);
    request.client_id = "client" + std::to_string(client);
    return request;
  };
  for (int i = 0; i < kMoves; ++i) {
    for (int client = 0; client < kClients; ++client) sender.send(change(client, i));
  }
  for (int client = 0; client < kClients; ++client) {
    std::map<std::string, std::int64_t> last;
    for (int i = 0; i < kMoves; ++i) {
      const auto answer = sender.answer_to(change(client, i));
      ASSERT_TRUE(answer);
      ASSERT_EQ(answer->status, scene_response_t::STATUS_OK) << answer->message;
      EXPECT_GT(answer->scene.revision,
                std::exchange(last[answer->scene.name], answer->scene.revision));
    }
  }
  EXPECT_EQ(running.scenes.find("hall")->revision, hall + kClients * kMoves / 3);
  EXPECT_EQ(running.scenes.find("room")->revision, room + kClients * kMoves * 2 / 3);
  for (const auto& object : running.scenes.find("room")->objects) {
    EXPECT_EQ(object->bounds_W.sizes().x(), 1.0 + (kMoves - 1)) << object->name;
  }
}

}  // namespace
}  // namespace camway::service
