// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/part_drawer.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <optional>

#include "tests/correction/hill_case.h"

namespace camway::correction {
namespace {

using base::Deadline;
using motion::CubicPath;
using testing::Draw;

/// The hill of a case as a changed part that is to be drawn again.
class PartDrawerTest : public ::testing::Test {
 protected:
  PartDrawerTest() {
    corrected_.emplace(c_.straight, c_.ladder.keyframes, CorrectionLimits{1000, 0.0}, never_);
    const Candidate hill = c_.hill(draw_, 0.0);
    EXPECT_TRUE(corrected_->take(hill));
    part_ = corrected_->changed_parts().front();
    problem_ = corrected_->restored(part_, {}, c_.space().ball_radius_m());
    path_ = corrected_->path();
  }

  Draw draw_{7811};
  HillCase c_{draw_};
  const Deadline never_ = Deadline::never();
  std::optional<CorrectedPath> corrected_;
  ChangedPart part_;
  Problem problem_;
  CubicPath path_;
};

TEST_F(PartDrawerTest, RemovesKnotsAsFarAsTheCostAllows) {
  FreeSpace space = c_.space();
  std::size_t last = kHillKnots + 1;
  for (const double growth : {1.0001, 1.02, 1.5}) {
    PartDrawer drawer(problem_, part_, part_, Objective::kClosest, space, space, never_);
    std::optional<Drawing> drawing = drawer.drawing(drawer.choice().knots_of(path_), path_);
    ASSERT_TRUE(drawing);
    const double most = growth * drawing->cost;
    drawer.limit_cost(most);
    drawer.thin_out(*drawing);
    const CubicPath& path = drawing->drawn.candidate.path;
    EXPECT_LE(drawing->cost, most);
    EXPECT_DOUBLE_EQ(drawing->cost, drawer.cost(path));
    EXPECT_TRUE(drawer.choice().is_valid(drawing->knots_s));
    EXPECT_TRUE(c_.ladder.collisions(path).empty());
    EXPECT_LE(drawing->knots_s.size(), last) << growth;
    last = drawing->knots_s.size();
  }
  EXPECT_LT(last, std::size_t{kHillKnots} / 4);
}

TEST_F(PartDrawerTest, ProvesDrawingsInItsSpace) {
  const double kept_m = 0.95 * c_.clearance(path_).lower_bound_m;
  FreeSpace keeping = c_.space(kept_m);
  FreeSpace measured = c_.space();
  PartDrawer drawer(problem_, part_, part_, Objective::kClosest, keeping, measured, never_);
  std::optional<Drawing> drawing = drawer.drawing(drawer.choice().knots_of(path_), path_);
  ASSERT_TRUE(drawing);
  drawer.thin_out(*drawing);  // whatever it costs
  EXPECT_LT(drawing->knots_s.size(), std::size_t{kHillKnots} / 4);
  EXPECT_GE(c_.clearance(drawing->drawn.candidate.path).upper_bound_m, kept_m);
  FreeSpace wide = c_.space(3.0 * c_.clearance(path_).upper_bound_m);
  const PartDrawer too_wide(problem_, part_, part_, Objective::kClosest, wide, measured, never_);
  EXPECT_FALSE(too_wide.drawing(too_wide.choice().knots_of(path_), path_));
}

}  // namespace
}  // namespace camway::correction
