// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/spare_keyframes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "daemon/collision/clearance.h"
#include "daemon/correction/path/viewing_distance.h"
#include "daemon/correction/smoothing/objective_cost.h"
#include "tests/correction/ladder_case.h"
#include "tests/support/gap_problems.h"

namespace camway::correction {
namespace {

using base::Deadline;
using motion::CubicPath;
using testing::Draw;

constexpr int kManyKnots = 40;  // knots of the hill before keyframes are spared

/// A hill on many knots over a block, on the straight path between two keyframes.
class SpareKeyframes : public ::testing::TestWithParam<Objective> {
 protected:
  void draw_case(Draw& draw) {
    const double half_m = draw.uniform(2.0, 3.0);
    const double top_m = draw.uniform(0.1, 0.4);
    scene::Mesh mesh;
    testing::add_cuboid(mesh, {-9, -9, -0.2}, {9, top_m, 0.2});
    c_ = case_with(mesh, {at(0, {0, 0, half_m}), at(draw.uniform(3, 8), {0, 0, -half_m})});
    straight_ = c_.path();
    height_m_ = top_m + draw.uniform(0.1, 0.5);
  }

  [[nodiscard]] FreeSpace space() const {
    const FreeSpace plain(c_.query(), OrientationPolicy{});
    return FreeSpace(c_.query(), OrientationPolicy{}, closeness_of(straight_, plain, 3.0));
  }

  /// The hill with wrinkles, which make it longer and rougher, and up to `wrinkle_m` lower.
  [[nodiscard]] Candidate hill(Draw& draw, double wrinkle_m) const {
    const Problem problem = testing::problem_of_leg(c_.keyframes, 0);
    Offsets offsets{problem.knots(kManyKnots), 1, {}};
    for (int k = 1; k < kManyKnots; ++k) {
      const double share = std::sin(std::numbers::pi * k / kManyKnots);
      const double up_m = height_m_ - draw.uniform(0.0, wrinkle_m);
      const double aside_m = draw.uniform(-3.0, 3.0) * wrinkle_m;
      offsets.at.push_back({{share * aside_m, share * up_m, 0}, geometry::Vec4::Zero()});
    }
    return free_candidate(problem, {bumps_for(offsets, Ends::kFixed)}, space(), Deadline::never())
        .value();
  }

  [[nodiscard]] collision::PathClearance clearance(const CubicPath& path) const {
    return collision::path_clearance(c_.query().obstacles, path.path(), c_.body, Deadline::never())
        .value();
  }

  /// The part of a clearance that the objective asks for.
  [[nodiscard]] double wanted_m(double clearance_m) const {
    const double radii = measures_curve(GetParam()) ? kTightGap : kComfort;
    return std::min(clearance_m, radii * space().ball_radius_m());
  }

  /// The straight path changed by `hill`, after keyframes were spared.
  [[nodiscard]] CorrectedPath spared(const Candidate& hill, const CubicPath& before) const {
    CorrectedPath corrected(straight_, c_.keyframes, {1000, 0.0}, never_);
    CollisionList list(c_.collisions(straight_), corrected.keyframes_s());
    EXPECT_TRUE(corrected.take(hill));
    EXPECT_EQ(corrected.inserted_s().size(), std::size_t{kManyKnots} - 1);
    FreeSpace free = space();
    spare_keyframes(GetParam(), before, {}, free, corrected, list);
    return corrected;
  }

  [[nodiscard]] double value_of(const CubicPath& path) const {
    FreeSpace free = space();
    return objective_value(GetParam(), path, straight_, free);
  }

  const Deadline never_ = Deadline::never();
  LadderCase c_;
  CubicPath straight_;
  double height_m_ = 0.0;
};

TEST_P(SpareKeyframes, DrawsOnFewKnotsWhatIsHardlyWorse) {
  Draw draw(7801);
  for (int i = 0; i < 8; ++i) {
    draw_case(draw);
    const Candidate smooth = hill(draw, 0.0);
    const CubicPath before = hill(draw, 0.05).path;
    const CorrectedPath corrected = spared(smooth, before);

    const CubicPath& path = corrected.path();
    EXPECT_LE(corrected.inserted_s().size(), 5U) << i;
    EXPECT_TRUE(c_.collisions(path).empty()) << i;
    const double value = value_of(smooth.path);
    const double gained = value_of(before) - value;
    ASSERT_GT(gained, 0.0) << i;
    EXPECT_LE(value_of(path), value + 0.1 * gained) << i;
    EXPECT_GE(clearance(path).upper_bound_m, 0.995 * wanted_m(clearance(smooth.path).lower_bound_m))
        << i;
    for (const motion::Keyframe& keyframe : c_.keyframes) {
      EXPECT_EQ(path.pose(keyframe.time_s).position, keyframe.pose.position);
    }
  }
}

TEST_P(SpareKeyframes, LeavesWhatIsNoBetterThanBefore) {
  Draw draw(7802);
  draw_case(draw);
  const Candidate rough = hill(draw, 0.05);
  const CubicPath before = hill(draw, 0.0).path;
  EXPECT_EQ(spared(rough, before).inserted_s().size(), std::size_t{kManyKnots} - 1);
}

INSTANTIATE_TEST_SUITE_P(Objectives, SpareKeyframes,
                         ::testing::Values(Objective::kShortest, Objective::kSmoothest,
                                           Objective::kSafest));

}  // namespace
}  // namespace camway::correction
