// SPDX-License-Identifier: MIT
//
// Runs the fuzzers' entry points on mutants of a fixed seed in every build.
#include "tests/fuzz/targets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "tests/messages/message_mutation.h"
#include "tests/messages/random_messages.h"
#include "tests/support/case_name.h"
#include "tests/support/random.h"

namespace camway::testing {
namespace {

class FuzzTargetTest : public ::testing::TestWithParam<FuzzTarget> {
 protected:
  const FuzzTarget& target() const { return GetParam(); }
  /// CAMWAY_MUTANTS asks for another number of them.
  int mutants() const {
    const char* const asked = std::getenv("CAMWAY_MUTANTS");
    return asked == nullptr ? target().mutants : std::atoi(asked);
  }
};

TEST_P(FuzzTargetTest, SomeOfItsSeedsAreRight) {
  std::size_t right = 0;
  const std::vector<FuzzBytes> seeds = target().seeds();
  for (const FuzzBytes& seed : seeds) right += target().exercise(seed) ? 1U : 0U;
  EXPECT_GT(right, 0U);
}

TEST_P(FuzzTargetTest, MutantsBreakNoPromise) {
  Random random(kSeed);
  const std::vector<FuzzBytes> seeds = target().seeds();
  constexpr std::size_t kLargest = 20'000;
  int right = 0;
  for (int trial = 0; trial < mutants(); ++trial) {
    SCOPED_TRACE(::testing::Message() << "trial " << trial);
    FuzzBytes bytes = seeds[below(random, seeds.size())];
    if (bytes.size() > kLargest) continue;
    if (trial % 5 == 0) bytes.resize(below(random, bytes.size() + 1));
    mutate(bytes, random);
    bytes.shrink_to_fit();  // so that a sanitizer sees one byte too many
    ASSERT_NO_THROW(right += target().exercise(bytes) ? 1 : 0);
  }
  EXPECT_LT(right, mutants()) << "the mutants are too tame";
}

TEST_P(FuzzTargetTest, NoiseBreaksNoPromise) {
  Random random(kSeed);
  for (int trial = 0; trial < target().mutants / 10; ++trial) {
    FuzzBytes bytes(below(random, 300));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    ASSERT_NO_THROW(target().exercise(bytes)) << "trial " << trial;
  }
}

INSTANTIATE_TEST_SUITE_P(All, FuzzTargetTest, ::testing::ValuesIn(fuzz_targets()), name_of_case);

}  // namespace
}  // namespace camway::testing
