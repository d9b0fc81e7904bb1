// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "daemon/messages/plan.h"
#include "lcmtypes/wire/pages.h"
#include "tests/messages/plan_samples.h"
#include "tests/support/allocation_meter.h"

namespace camway::wire {
namespace {

// An answer that exceeds the largest number of pages is refused before any page is made.
TEST(WirePages, CountingThemAllocatesNothing) {
  testing::Random random(testing::kSeed);
  const plan_response_t answer =
      messages::to_wire(testing::sample_result(2000, random), messages::AnswerHeader{});
  const testing::AllocationMeter meter;
  const std::size_t pages = wire::count_pages(answer);
  ASSERT_EQ(meter.bytes(), 0U);
  EXPECT_EQ(pages, wire::encode_pages(answer).size());
  EXPECT_GT(pages, 10U);
  EXPECT_GT(meter.bytes(), 0U) << "the meter counts nothing";
}

}  // namespace
}  // namespace camway::wire
