// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/spare_keyframes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>

#include "daemon/correction/smoothing/objective_cost.h"
#include "tests/correction/hill_case.h"

namespace camway::correction {
namespace {

using base::Deadline;
using motion::CubicPath;
using testing::Draw;

class SpareKeyframes : public ::testing::TestWithParam<Objective> {
 protected:
  /// The straight path changed by `hill`, after keyframes were spared.
  [[nodiscard]] CorrectedPath spared(const HillCase& c, const Candidate& hill,
                                     const CubicPath& before) const {
    CorrectedPath corrected(c.straight, c.ladder.keyframes, {1000, 0.0}, never_);
    CollisionList list(c.ladder.collisions(c.straight), corrected.keyframes_s());
    EXPECT_TRUE(corrected.take(hill));
    EXPECT_EQ(corrected.inserted_s().size(), std::size_t{kHillKnots} - 1);
    FreeSpace space = c.space();
    spare_keyframes(GetParam(), before, {}, space, corrected, list);
    return corrected;
  }

  [[nodiscard]] static double value_of(const HillCase& c, const CubicPath& path) {
    FreeSpace space = c.space();
    return objective_value(GetParam(), path, c.straight, space);
  }

  /// The part of a clearance that the objective asks for.
  [[nodiscard]] static double wanted_m(const HillCase& c, double clearance_m) {
    const double radii = measures_curve(GetParam()) ? kTightGap : kComfort;
    return std::min(clearance_m, radii * c.space().ball_radius_m());
  }

  const Deadline never_ = Deadline::never();
};

TEST_P(SpareKeyframes, DrawsOnFewKnotsWhatIsHardlyWorse) {
  Draw draw(7801);
  for (int i = 0; i < 8; ++i) {
    const HillCase c(draw);
    const Candidate smooth = c.hill(draw, 0.0);
    const CubicPath before = c.hill(draw, 0.05).path;
    const CorrectedPath corrected = spared(c, smooth, before);

    const CubicPath& path = corrected.path();
    EXPECT_LE(corrected.inserted_s().size(), 5U) << i;
    EXPECT_TRUE(c.ladder.collisions(path).empty()) << i;
    const double value = value_of(c, smooth.path);
    const double gained = value_of(c, before) - value;
    ASSERT_GT(gained, 0.0) << i;
    EXPECT_LE(value_of(c, path), value + 0.1 * gained) << i;
    EXPECT_GE(c.clearance(path).upper_bound_m,
              0.995 * wanted_m(c, c.clearance(smooth.path).lower_bound_m))
        << i;
    for (const motion::Keyframe& keyframe : c.ladder.keyframes) {
      EXPECT_EQ(path.pose(keyframe.time_s).position, keyframe.pose.position);
    }
  }
}

TEST_P(SpareKeyframes, LeavesWhatIsNoBetterThanBefore) {
  Draw draw(7802);
  const HillCase c(draw);
  const Candidate rough = c.hill(draw, 0.05);
  const CubicPath before = c.hill(draw, 0.0).path;
  EXPECT_EQ(spared(c, rough, before).inserted_s().size(), std::size_t{kHillKnots} - 1);
}

INSTANTIATE_TEST_SUITE_P(Objectives, SpareKeyframes,
                         ::testing::Values(Objective::kShortest, Objective::kSmoothest,
                                           Objective::kSafest));

}  // namespace
}  // namespace camway::correction
