// SPDX-License-Identifier: MIT
#include "tools/support/client_request.h"

#include <gtest/gtest.h>

#include <camway/plan_request_t.hpp>

#include "client/messages/plan.h"
#include "daemon/messages/convert.h"
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

// The client sends a request bit for bit as the daemon itself writes it.
TEST(ClientRequest, EveryBodyAndKeyframeReachesTheDaemon) {
  testing::Random random(testing::kSeed);
  for (const auto& body : testing::sample_bodies(random)) {
    for (const std::size_t keyframes : {0U, 2U, 9U}) {
      planning::PlanRequest request = testing::sample_request(keyframes, random);
      if (keyframes == 0) request.has_times = false;  // the client has times in keyframes alone
      request.body = body;
      request.scene = "room";
      auto page =
          wire::decode<plan_request_t>(to_pages(to_client_request(request, "room"), "me", 7).at(0));
      ASSERT_TRUE(page.message) << page.fault.text("plan_request_t");
      page.message->utime = 0;
      EXPECT_EQ(wire::encode(*page.message), wire::encode(messages::to_wire(request, {"me", 7})));
    }
  }
}

}  // namespace
}  // namespace camway::tools
