// SPDX-License-Identifier: MIT
#include "daemon/scene/snapshot/change_ticket.h"

#include <gtest/gtest.h>

#include <latch>
#include <thread>

namespace camway::scene {
namespace {

TEST(ChangeTicket, IsCommittedOrCancelledAsTheFirstCallSays) {
  const ChangeTicket made;
  EXPECT_FALSE(made.stop().stop_requested());
  EXPECT_TRUE(made.try_commit());
  EXPECT_FALSE(made.cancel());
  EXPECT_FALSE(made.is_cancelled());
  EXPECT_FALSE(made.stop().stop_requested());
  EXPECT_TRUE(made.try_commit()) << "it still is";

  const ChangeTicket left;
  const ChangeTicket& same = ChangeTicket(left);
  EXPECT_TRUE(same.cancel());
  EXPECT_FALSE(left.cancel()) << "only one may say so";
  EXPECT_FALSE(left.try_commit());
  EXPECT_TRUE(left.is_cancelled());
  EXPECT_TRUE(left.stop().stop_requested());
  EXPECT_FALSE(ChangeTicket().is_cancelled()) << "another one";
}

TEST(ChangeTicket, IsNeverBoth) {
  for (int run = 0; run < 300; ++run) {
    const ChangeTicket ticket;
    std::latch begin(2);
    bool is_cancelled = false;
    std::jthread other([&] {
      begin.arrive_and_wait();
      is_cancelled = ticket.cancel();
    });
    begin.arrive_and_wait();
    const bool is_committed = ticket.try_commit();
    other.join();
    ASSERT_NE(is_committed, is_cancelled);
  }
}

}  // namespace
}  // namespace camway::scene
