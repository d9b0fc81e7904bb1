// SPDX-License-Identifier: MIT
#include "tools/support/client_response.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "client/messages/convert.h"
#include "client/messages/plan.h"
#include "daemon/messages/plan.h"
#include "tests/messages/plan_samples.h"
#include "tests/support/random.h"
#include "tools/json/json_response.h"

namespace camway::tools {
namespace {

/// The result as it comes out of a client that received it.
planning::PlanResult received(const planning::PlanResult& result) {
  const plan_response_t wire = messages::to_wire(result, {});
  PlanResponse response;
  convert(wire, response);
  std::vector<Segment> segments;
  convert(wire.segments, segments);
  response.path = Path(segments);
  return to_plan_result(response);
}

// Files have all that answers say, so files that are equal are answers that are.
TEST(ClientResponse, MakesTheFileThatTheDaemonsResultWouldMake) {
  testing::Random random(testing::kSeed);
  for (std::size_t trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(::testing::Message() << "trial " << trial);
    planning::PlanResult result = testing::sample_result(trial % 4, random);
    // The time of loading a scene is not in messages.
    result.timing.load_scene_ms = 0.0;
    const auto here = write_plan_response(result);
    const auto there = write_plan_response(received(result));
    ASSERT_TRUE(here) << here.error;
    ASSERT_TRUE(there) << there.error;
    EXPECT_EQ(*there, *here);
  }
}

TEST(ClientResponse, KnowsWhichAnswersHaveAResult) {
  EXPECT_TRUE(has_result(Status::kOk));
  EXPECT_TRUE(has_result(Status::kUnknownScene));
  EXPECT_TRUE(has_result(Status::kInternalError));
  EXPECT_FALSE(has_result(Status::kOverloaded));
  EXPECT_FALSE(has_result(Status::kCancelled));
  EXPECT_FALSE(has_result(Status::kNoDaemon));
}

}  // namespace
}  // namespace camway::tools
