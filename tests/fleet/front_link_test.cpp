// SPDX-License-Identifier: MIT
#include "daemon/fleet/front_link.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <deque>
#include <memory>
#include <thread>
#include <vector>

#include "daemon/fleet/planner_board.h"
#include "tests/support/captured_log.h"
#include "tests/support/memory_bus.h"

namespace camway::fleet {
namespace {

using std::chrono::milliseconds;
using testing::MemoryBus;
using testing::MemoryNetwork;

constexpr std::uint64_t kClaimSeed = 20261126;

/// A front that says several times a second that it is alive.
class ClaimingFront {
 public:
  explicit ClaimingFront(MemoryNetwork& network, const std::string& id = "same")
      : bus_(network),
        link_(bus_, board_, Subjects{"fleet"}, id, log_.log()),
        ticking_([this](const std::stop_token& stop) {
          while (!stop.stop_requested()) {
            std::this_thread::sleep_for(milliseconds(50));
            link_.say_alive();
          }
        }) {}
  FrontLink& link() { return link_; }

 private:
  testing::CapturedLog log_;
  MemoryBus bus_;
  PlannerBoard board_{"version"};
  FrontLink link_;
  std::jthread ticking_;
};

TEST(FrontLink, ALaterFrontDoesNotGetTheIdOfOneThatLives) {
  MemoryNetwork network(kClaimSeed);
  ClaimingFront first(network);
  ASSERT_TRUE(first.link().claim_id());
  ClaimingFront other(network, "other");
  EXPECT_TRUE(other.link().claim_id());
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(ClaimingFront(network).link().claim_id()) << i;
  first.link().leave_id();
  EXPECT_TRUE(ClaimingFront(network).link().claim_id());
}

TEST(FrontLink, OneOfManyStartsGetsTheId) {
  testing::Random random(kClaimSeed);
  for (int round = 0; round < 6; ++round) {
    MemoryNetwork network(kClaimSeed + static_cast<std::uint64_t>(round));
    std::deque<ClaimingFront> fronts;
    std::vector<std::jthread> starts;
    std::atomic<int> settled = 0;
    for (int i = 0; i < 4; ++i) {
      ClaimingFront& front = fronts.emplace_back(network);
      // Together, or a part of the time apart that a claim takes.
      const milliseconds delay(round < 2 ? 0 : random.integer(0, 900));
      starts.emplace_back([&front, &settled, delay] {
        std::this_thread::sleep_for(delay);
        if (front.link().claim_id()) ++settled;
      });
    }
    starts.clear();
    EXPECT_EQ(settled, 1) << "round " << round;
  }
}

}  // namespace
}  // namespace camway::fleet
