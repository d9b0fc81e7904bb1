// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <deque>
#include <limits>
#include <thread>
#include <tuple>
#include <utility>

#include "daemon/fleet/remote_answerer.h"
#include "daemon/messages/plan.h"
#include "daemon/service/heartbeat.h"
#include "tests/fleet/test_fleet.h"
#include "tests/messages/request_on_wire.h"
#include "tests/support/scenes.h"

namespace camway::fleet {
namespace {

using std::chrono::milliseconds;
using testing::Asked;
using testing::eventually;
using testing::MemoryNetwork;
using testing::Random;
using testing::room_request;
using testing::rooms;
using testing::TestFront;
using testing::TestPlanner;
using testing::timeless;

constexpr std::uint64_t kFaultsSeed = 20261127;

TEST(RemoteAnswerer, LongRequestsAndAnswersTravelInParts) {
  constexpr std::size_t kKeyframes = 20'000;
  MemoryNetwork network(kFaultsSeed, 20'000);
  network.set_faults({.lost = 0.002, .doubled = 0.1, .longest_delay = milliseconds(1)});
  TestPlanner planner(network, "a");
  TestFront front(network, "front");
  const auto room = rooms(1).at(0);
  planner.follow(room);
  planner.start();
  front.follow(room);
  ASSERT_TRUE(front.wait_for_slots(1));
  Random random(kFaultsSeed);
  planning::PlanRequest request;
  request.camera = testing::small_camera();
  request.options.max_inserted_keyframes = 0;
  for (std::size_t i = 0; i < kKeyframes; ++i) {
    request.keyframes.push_back({0.0, {random.in_cube(4.0), random.rotation()}});
  }
  plan_request_t wire = messages::to_wire(request, {"client", 1, 0});
  wire.scene = "room";
  ASSERT_GT(wire.getEncodedSize(), 1'500'000);
  const plan_response_t answer = front.answer(wire, 200.0);
  EXPECT_GT(answer.getEncodedSize(), 4'000'000);
  EXPECT_EQ(timeless(answer), timeless(front.local(wire)));
  EXPECT_EQ(front.counts().planned_here, 0);
}

TEST(RemoteAnswerer, NamesThatAreNoneAreRefused) {
  MemoryNetwork network;
  TestFront front(network, "front");
  FrontOptions options;
  options.front_id = "a.b";
  const RemoteAnswerer::Parts parts{front.bus, front.board, front.scenes, front.here};
  const auto position = [](const std::string&) { return std::int64_t{0}; };
  EXPECT_FALSE(RemoteAnswerer::open(parts, options, position, front.log.log()));
  options.front_id = "ab";
  options.fleet = "*";
  EXPECT_FALSE(RemoteAnswerer::open(parts, options, position, front.log.log()));
}

// Whatever is lost, doubled and late, and whoever dies: every request gets the one right answer.
TEST(RemoteAnswerer, AnswersAllThroughRandomFaults) {
  constexpr int kClients = 4;
  constexpr int kEach = 12;
  const auto room = rooms(6).at(5);
  Random random(kFaultsSeed + 1);
  MemoryNetwork network(kFaultsSeed + 2, 3000);
  std::deque<TestPlanner> planners;
  for (const char* id : {"a", "b", "c"}) {
    TestPlanner& planner = planners.emplace_back(network, id, 2);
    planner.follow(room);
    planner.start();
  }
  TestFront front(network, "front");
  front.follow(room);
  ASSERT_TRUE(front.wait_for_slots(6));
  network.set_faults({.lost = 0.05, .doubled = 0.1, .longest_delay = milliseconds(20)});
  std::atomic<bool> is_done = false;
  std::thread trouble([&] {
    Random faults(kFaultsSeed + 3);
    while (!is_done) {
      TestPlanner& planner = planners[static_cast<std::size_t>(faults.integer(0, 2))];
      const auto pause = milliseconds(faults.integer(20, 1500));
      const bool is_cut = faults.chance(0.5);
      is_cut ? planner.bus.cut() : planner.bus.stall();
      for (auto slept = milliseconds(0); slept < pause && !is_done; slept += milliseconds(10)) {
        std::this_thread::sleep_for(milliseconds(10));
      }
      is_cut ? planner.bus.mend() : planner.bus.go_on();
    }
  });
  std::vector<std::vector<plan_request_t>> requests(kClients);
  for (int client = 0; client < kClients; ++client) {
    for (int id = 1; id <= kEach; ++id) {
      requests[static_cast<std::size_t>(client)].push_back(
          room_request("client" + std::to_string(client), id, random));
    }
  }
  std::atomic<int> right = 0;
  std::vector<std::thread> clients;
  for (const auto& of_client : requests) {
    clients.emplace_back([&] {
      for (const plan_request_t& request : of_client) {
        const plan_response_t answer = front.answer(request, 60.0);
        right += timeless(answer) == timeless(front.local(request)) ? 1 : 0;
      }
    });
  }
  for (std::thread& client : clients) client.join();
  is_done = true;
  trouble.join();
  EXPECT_EQ(right, kClients * kEach);
  EXPECT_EQ(front.counts().differing_answers, 0);
  EXPECT_GT(front.counts().jobs_sent_again, 0) << "or nothing was tested";
  EXPECT_EQ(front.log.text().find("it is to another request"), std::string::npos);
}

}  // namespace
}  // namespace camway::fleet
