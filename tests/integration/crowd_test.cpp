// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "client/messages/plan.h"
#include "tests/integration/fixture.h"
#include "tools/camway/load/load_tally.h"

namespace camway::integration {
namespace {

using ::testing::HasSubstr;

/// Clients that overload the daemon.
class CrowdTest : public IntegrationTest {};

/// The bound is not a time but a number of turns: a client with occasional requests waits for the
/// one that is being planned, but for no other client's queue.
TEST_F(CrowdTest, WhoFloodsKeepsNobodyWaiting) {
  start_daemon({"--workers", "1"});
  Client flood(patient());
  std::atomic<int> flooded = 0;
  PlanHandlers handlers;
  handlers.on_answer = [&](const PlanResponse& answer) { flooded += answer.ok() ? 1 : 0; };
  const PlanRequest slow = request_of("maze-wall-neighbours", "maze");
  constexpr int kFlood = 500;  // a minute of work, and more than may wait
  for (int i = 0; i < kFlood; ++i) flood.plan_async(slow, handlers);
  ClientOptions options = patient();
  options.try_timeout_s = 10.0;
  options.max_try_timeout_s = 10.0;
  Client client(options);
  ASSERT_TRUE(eventually([&] { return flooded > 0; }));
  ASSERT_TRUE(eventually([&] { return client.status().overloaded_requests > 0; }))
      << "who sends more than may wait is told so";

  std::vector<int> planned_before;
  for (int i = 0; i < 11; ++i) {
    const int before = flooded;
    const PlanResponse answer = client.plan(request_of("office-free-door", "office"));
    ASSERT_TRUE(answer.ok()) << answer.error;
    planned_before.push_back(flooded - before);
  }
  // One or two requests may be lost together with the flood's.
  std::ranges::sort(planned_before);
  EXPECT_LE(planned_before[planned_before.size() / 2], 2);
  EXPECT_LT(flooded, kFlood) << "or there was no flood";
  const int so_far = flooded;
  EXPECT_TRUE(eventually([&] { return flooded > so_far; })) << "nor does the flood get nothing";
}

/// A host that invents a client for each request. Clients share the time, so it would have as much
/// as it invents, but all newcomers together count as a few.
TEST_F(CrowdTest, WhoInventsClientsKeepsNobodyWaiting) {
  start_daemon({"--workers", "1"});
  ClientOptions options = patient();
  options.try_timeout_s = 10.0;
  options.max_try_timeout_s = 10.0;
  Client client(options);
  const PlanRequest quick = request_of("office-free-door", "office");
  ASSERT_TRUE(client.plan(quick).ok());

  const PlanRequest slow = request_of("maze-wall-neighbours", "maze");
  std::jthread flood([&](const std::stop_token& stop) {
    lcm::LCM lcm;
    for (int i = 0; !stop.stop_requested(); ++i) {
      for (const auto& page : to_pages(slow, "invented" + std::to_string(i), 1)) {
        lcm.publish("CAMWAY_PLAN_REQUEST", page.data(), static_cast<unsigned>(page.size()));
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  });
  ASSERT_TRUE(eventually([&] { return client.status().overloaded_requests > 0; }))
      << "the queue is full";
  const std::int64_t answered_before = client.status().answered_requests;
  for (int i = 0; i < 10; ++i) {
    const PlanResponse answer = client.plan(quick);
    EXPECT_TRUE(answer.ok()) << answer.error;
  }
  EXPECT_GT(client.status().answered_requests, answered_before + 10) << "or there was no flood";
}

/// A process that is stopped reads nothing and acknowledges nothing, and its sockets are full.
TEST_F(CrowdTest, WhoNeverReadsHoldsUpNobodyAndTakesNoMemory) {
  start_daemon();
  Process watch({CAMWAY_BINARY, "watch", "office", "--request", request_file("office-free-door"),
                 "--count", "1000000", "--json"},
                file("watch.log"));
  ASSERT_TRUE(eventually([&] {
    return watch.output().find("\"event\":\"answer\"") != std::string::npos;
  })) << watch.output();
  watch.signal(SIGSTOP);

  // A crate that jumps back and forth on its path: the way around the one place leads through the
  // other.
  Client client(patient());
  std::array<Pose, 2> places;
  places[0].position_m = {9.75, 1.5, 9.5};
  places[1].position_m = {9.75, 1.5, 7.3};
  ASSERT_TRUE(client.put_object("office", "crate", SceneBox{{0.4, 0.4, 0.4}}, places[1]).ok());
  const auto change = [&](int times) {
    for (int i = 0; i < times; ++i) {
      const SceneAnswer moved =
          client.move_object("office", "crate", places.at(static_cast<std::size_t>(i) % 2));
      ASSERT_TRUE(moved.ok()) << moved.error;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));  // for news to be made of it
    }
  };
  const std::int64_t told_before = client.status().broken_paths;
  ASSERT_NO_FATAL_FAILURE(change(250));
  [[maybe_unused]] const double before_mb = tools::resident_mb(daemon().pid());
  ASSERT_NO_FATAL_FAILURE(change(250));
#ifndef __SANITIZE_ADDRESS__  // which keeps what was freed
  EXPECT_LT(tools::resident_mb(daemon().pid()) - before_mb, 16.0) << before_mb << " MB before";
#endif
  EXPECT_TRUE(eventually([&] { return client.status().broken_paths > told_before + 30; }))
      << "or there was nothing to tell";
  EXPECT_TRUE(client.plan(request_of("office-free-turn", "office")).ok());

  // When it reads again it is told the present state only: the scene is gone.
  ASSERT_TRUE(client.unload_scene("office").ok());
  watch.signal(SIGCONT);
  EXPECT_TRUE(eventually([&] {
    return watch.output().find("\"event\":\"broken\",\"scene_revision\":0") != std::string::npos;
  })) << watch.output();
}

/// Most pages of an answer find no room in a buffer for one page.
TEST_F(CrowdTest, ATinyReceiveBufferIsEnough) {
  start_daemon();
  ClientOptions options = patient();
  options.url = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=2304";
  const SceneMap map = Client(options).export_map("office");
  ASSERT_TRUE(map.ok()) << map.error;
  EXPECT_EQ(map.bytes, Client(patient()).export_map("office").bytes);
}

}  // namespace
}  // namespace camway::integration
