// SPDX-License-Identifier: MIT
#include "daemon/motion/path/time_origin.h"

#include "tests/motion/random_motion.h"

namespace camway::motion {
namespace {

using testing::Random;

TEST(TimeOrigin, GivesEachTimeOfThePathBackBitForBit) {
  Random random(3401);
  int far = 0;
  for (int round = 0; round < 20000; ++round) {
    const double first_s = (random.chance(0.5) ? 1.0 : -1.0) * random.log_uniform(1e-6, 1e10);
    const double duration_s = random.log_uniform(1e-3, 1e5);
    const TimeOrigin origin = TimeOrigin::of(first_s, first_s + duration_s);
    far += origin.s != 0.0 ? 1 : 0;
    for (int i = 0; i < 5; ++i) {
      const double time_s = first_s + random.uniform(0.0, 1.0) * duration_s;
      ASSERT_EQ(origin.sent_s(origin.local_s(time_s)), time_s) << first_s << ' ' << duration_s;
      // Exact, so that durations are the same.
      ASSERT_EQ(static_cast<long double>(time_s) - origin.s, origin.local_s(time_s));
    }
  }
  EXPECT_GT(far, 5000);
}

TEST(TimeOrigin, IsZeroWhereNothingIsGained) {
  EXPECT_EQ(TimeOrigin::of(0.0, 5.0).s, 0.0);
  EXPECT_EQ(TimeOrigin::of(-2.0, 5.0).s, 0.0);
  EXPECT_EQ(TimeOrigin::of(1.0, 5.0).s, 0.0);
  EXPECT_EQ(TimeOrigin::of(1.76e9, 1.76e9 + 5.0).s, 1.76e9);
  EXPECT_EQ(TimeOrigin::of(-1.76e9, -1.76e9 + 5.0).s, -1.76e9);
}

TEST(TimeOrigin, NearestIsExactForTheSender) {
  Random random(3402);
  for (int round = 0; round < 20000; ++round) {
    const TimeOrigin origin{random.log_uniform(1.0, 4e9)};
    const double wanted_s = random.uniform(0.0, 0.9) * origin.s;
    const double time_s = origin.nearest_s(wanted_s);
    ASSERT_EQ(static_cast<long double>(origin.s) + time_s, origin.sent_s(time_s));
    ASSERT_LE(std::abs(time_s - wanted_s), 0.51 * origin.resolution_s(wanted_s));
    ASSERT_EQ(origin.nearest_s(time_s), time_s);
  }
}

TEST(TimeOrigin, RoundsToEitherSide) {
  Random random(3403);
  int apart = 0;
  for (int round = 0; round < 5000; ++round) {
    const TimeOrigin origin{random.log_uniform(1.0, 4e9)};
    const double time_s = random.uniform(0.0, 0.9) * origin.s;
    const long double exact_s = static_cast<long double>(origin.s) + time_s;
    const double early_s = origin.sent_not_after_s(time_s);
    const double late_s = origin.sent_not_before_s(time_s);
    ASSERT_LE(early_s, exact_s);
    ASSERT_GE(late_s, exact_s);
    ASSERT_LE(late_s - early_s, origin.resolution_s(time_s));
    apart += early_s < late_s ? 1 : 0;
  }
  EXPECT_GT(apart, 1000);
}

}  // namespace
}  // namespace camway::motion
