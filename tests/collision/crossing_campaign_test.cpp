// SPDX-License-Identifier: MIT
#include "tests/collision/crossing_campaign.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace camway::testing {
namespace {

constexpr std::uint64_t kSeed = 20;
constexpr std::uint64_t kCases = 10'010;  // as many of each family

std::string name_of(std::size_t family) {
  return std::string(to_string(static_cast<CrossingFamily>(family)));
}

// tests/bench/bench_campaign runs the same campaign with a hundred times as many cases.
TEST(CrossingCampaign, NoCrossingIsMissedAndNoClearanceOverstated) {
  std::printf("[   SEED   ] %llu\n", static_cast<unsigned long long>(kSeed));
  const CampaignResult result = run_crossing_campaign(kSeed, 0, kCases, 2);
  for (std::size_t f = 0; f < kCrossingFamilies; ++f) {
    const CrossingTally& tally = result.families[f];
    EXPECT_EQ(tally.cases, kCases / kCrossingFamilies) << name_of(f);
    EXPECT_EQ(tally.misses, 0u) << name_of(f);
    EXPECT_EQ(tally.false_alarms, 0u) << name_of(f);
    EXPECT_EQ(tally.clearance_above_truth, 0u) << name_of(f);
    EXPECT_EQ(tally.clearance_too_low, 0u) << name_of(f);
    // Cases that are drawn again are not tested, so they must be the exception.
    EXPECT_LT(tally.redrawn, tally.cases) << name_of(f);
  }
  for (const std::uint64_t index : result.faults) {
    ADD_FAILURE() << "case " << index << " of seed " << kSeed;
  }
}

TEST(CrossingCampaign, DoesNotDependOnThreads) {
  for (const std::uint64_t index : {0u, 7u, 12u}) {
    const CrossingCase a = make_crossing_case(kSeed, index);
    const CrossingCase b = make_crossing_case(kSeed, index);
    EXPECT_EQ(a.known_s, b.known_s);
    EXPECT_EQ(a.obstacle.vertices, b.obstacle.vertices);
  }
  const CrossingTally one = run_crossing_campaign(kSeed, 0, 600, 1).total();
  const CrossingTally three = run_crossing_campaign(kSeed, 0, 600, 3).total();
  EXPECT_EQ(one.cases, 600u);
  EXPECT_EQ(one.cases, three.cases);
  EXPECT_EQ(one.redrawn, three.redrawn);
}

}  // namespace
}  // namespace camway::testing
