// SPDX-License-Identifier: MIT
#include "daemon/scene/snapshot/change_ticket.h"

#include <gtest/gtest.h>

#include <latch>
#include <thread>

namespace camway::scene {
namespace {

TEST(Undertaking, IsInForceOrCalledOffAsTheFirstSays) {
  const Undertaking made;
  EXPECT_FALSE(made.stop().stop_requested());
  EXPECT_TRUE(made.come_into_force());
  EXPECT_FALSE(made.call_off());
  EXPECT_FALSE(made.is_called_off());
  EXPECT_FALSE(made.stop().stop_requested());
  EXPECT_TRUE(made.come_into_force()) << "it still is";

  const Undertaking left;
  const Undertaking& same = Undertaking(left);
  EXPECT_TRUE(same.call_off());
  EXPECT_FALSE(left.call_off()) << "only one may say so";
  EXPECT_FALSE(left.come_into_force());
  EXPECT_TRUE(left.is_called_off());
  EXPECT_TRUE(left.stop().stop_requested());
  EXPECT_FALSE(Undertaking().is_called_off()) << "another one";
}

TEST(Undertaking, IsNeverBoth) {
  for (int run = 0; run < 300; ++run) {
    const Undertaking undertaking;
    std::latch begin(2);
    bool is_called_off = false;
    std::jthread other([&] {
      begin.arrive_and_wait();
      is_called_off = undertaking.call_off();
    });
    begin.arrive_and_wait();
    const bool is_in_force = undertaking.come_into_force();
    other.join();
    ASSERT_NE(is_in_force, is_called_off);
  }
}

}  // namespace
}  // namespace camway::scene
