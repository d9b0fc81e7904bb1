// SPDX-License-Identifier: MIT
#include "tools/support/client_request.h"

#include <gtest/gtest.h>

#include <camway/plan_request_t.hpp>

#include "client/messages/plan.h"
#include "daemon/messages/plan.h"
#include "lcmtypes/wire/check.h"
#include "tests/messages/plan_samples.h"

namespace camway::tools {
namespace {

// Converts from memory to the client's structs and the wire, and back as the daemon reads it.
TEST(ClientRequest, EveryOptionReachesTheDaemon) {
  testing::Random random(testing::kSeed);
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(::testing::Message() << "trial " << trial);
    planning::PlanRequest request = testing::sample_request(2, random);
    request.options = testing::sample_options(random);
    const auto pages = to_pages(to_client_request(request, "room"), "me", 7);
    ASSERT_EQ(pages.size(), 1U);
    const auto page = wire::decode<plan_request_t>(pages[0]);
    ASSERT_TRUE(page.message) << page.fault.text("plan_request_t");
    const auto read = messages::from_wire(*page.message);
    ASSERT_TRUE(read) << read.error;
    EXPECT_EQ(read->options, request.options);
  }
}

// The daemon reads what was sent, and it is sent again bit for bit.
TEST(ClientRequest, EveryBodyAndKeyframeReachesTheDaemon) {
  testing::Random random(testing::kSeed);
  for (const auto& body : testing::sample_bodies(random)) {
    for (const std::size_t keyframes : {0U, 2U, 9U}) {
      planning::PlanRequest request = testing::sample_request(keyframes, random);
      if (keyframes == 0) request.has_times = false;  // the client has times in keyframes alone
      request.body = body;
      const auto bytes = to_pages(to_client_request(request, "room"), "me", 7).at(0);
      const auto page = wire::decode<plan_request_t>(bytes);
      ASSERT_TRUE(page.message) << page.fault.text("plan_request_t");
      const auto read = messages::from_wire(*page.message);
      ASSERT_TRUE(read) << read.error;
      EXPECT_EQ(read->scene, "room");
      EXPECT_EQ(read->has_times, request.has_times);
      EXPECT_EQ(read->frame, request.frame);
      EXPECT_EQ(planning::body_shape(*read).index(), planning::body_shape(request).index());
      ASSERT_EQ(read->keyframes.size(), keyframes);
      for (std::size_t i = 0; i < keyframes; ++i) {
        EXPECT_EQ(read->keyframes[i].pose.position, request.keyframes[i].pose.position);
        EXPECT_EQ(read->keyframes[i].image, request.keyframes[i].image);
      }
      const auto again = to_pages(to_client_request(*read, "room"), "me", 7).at(0);
      auto repeated = *wire::decode<plan_request_t>(again).message;
      repeated.utime = page.message->utime;
      EXPECT_EQ(wire::encode(repeated), bytes);
    }
  }
}

}  // namespace
}  // namespace camway::tools
