// SPDX-License-Identifier: MIT
//
// Runs the fuzzer's entry point on mutants of a fixed seed in every build.
#include <gtest/gtest.h>

#include "lcmtypes/wire/check.h"
#include "tests/fuzz/exercise_message.h"
#include "tests/messages/message_mutation.h"
#include "tests/messages/random_messages.h"
#include "tests/support/random.h"

namespace camway::testing {
namespace {

template <class Message>
class WireFuzz : public ::testing::Test {};
using Exercised = ::testing::Types<plan_request_t, plan_response_t, occupancy_request_t, cancel_t,
                                   missing_pages_t, plan_progress_t, scene_request_t, upload_page_t,
                                   watch_t, watch_report_t, occupancy_response_t, scene_response_t,
                                   upload_status_t, map_page_t, claim_t, status_t, error_t,
                                   envelope_t, fleet_job_t, fleet_answer_t, planner_status_t>;
TYPED_TEST_SUITE(WireFuzz, Exercised);

TYPED_TEST(WireFuzz, MutantsBreakNoPromise) {
  constexpr int kMutants = 10'000;
  Random random(kSeed);
  std::vector<std::uint8_t> original;
  int right = 0;
  for (int trial = 0; trial < kMutants; ++trial) {
    SCOPED_TRACE(::testing::Message() << "trial " << trial);
    if (trial % 20 == 0) original = wire::encode(random_message<TypeParam>(random));
    std::vector<std::uint8_t> bytes = original;
    mutate(bytes, random);
    ASSERT_NO_THROW(right += exercise_message(bytes));
  }
  EXPECT_GT(right, kMutants / 50) << "the mutants are too wild to reach the converters";
  EXPECT_LT(right, kMutants);
}

TYPED_TEST(WireFuzz, NoiseBreaksNoPromise) {
  Random random(kSeed);
  for (int trial = 0; trial < 5000; ++trial) {
    std::vector<std::uint8_t> bytes(below(random, 300));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    ASSERT_EQ(exercise_message(bytes), 0) << "trial " << trial;
  }
}

}  // namespace
}  // namespace camway::testing
