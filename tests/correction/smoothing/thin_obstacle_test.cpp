// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <optional>

#include "daemon/correction/path/closeness.h"
#include "daemon/correction/smoothing/relaxation.h"
#include "tests/support/gap_problems.h"

namespace camway::correction {
namespace {

using base::Deadline;

constexpr double kHeight_m = 1.4;   // of a plate, above the lower edge of the near quadrilateral
constexpr double kThin_m = 0.002;   // its thickness: samples lie beside it
constexpr double kTooHigh_m = 2.4;  // coefficients of a row over it

/// A path along z through a plate, and a correction that leads high over it.
class ThinObstacleTest : public ::testing::Test {
 protected:
  ThinObstacleTest() {
    testing::add_plate_across(mesh_, kHeight_m, kThin_m);
    index_ = scene::SceneIndex::build(mesh_);
    problem_ = testing::problem_along_z();
  }

  [[nodiscard]] FreeSpace space() const {
    OrientationPolicy keep;
    keep.rule = OrientationRule::kKeep;
    return FreeSpace({collision::Obstacles(index_), body_, {}}, keep);
  }

  [[nodiscard]] std::optional<Relaxed> high_over_it() const {
    Offsets offsets{{problem_.leg_begin_s(), problem_.leg_end_s(), 12}, 1, {}};
    for (int k = 1; k < 12; ++k) offsets.at.push_back({{0, kTooHigh_m, 0}, geometry::Vec4::Zero()});
    FreeSpace space = this->space();
    std::optional<Candidate> found =
        free_candidate(problem_, {bumps_for(offsets, Ends::kFixed)}, space, Deadline::never());
    if (!found) return std::nullopt;
    return Relaxed{offsets, *std::move(found)};
  }

  [[nodiscard]] double cost(const Relaxed& of) const {
    return closeness_cost(of.candidate.path, problem_.original, space().closeness());
  }

  scene::Mesh mesh_;
  scene::SceneIndex index_;
  motion::Body body_{testing::small_camera()};
  Problem problem_;
};

// The first steps lead through the plate, where no sample is: there the path is taken back.
TEST_F(ThinObstacleTest, IsPassedNearlyAfterFewSteps) {
  const std::optional<Relaxed> high = high_over_it();
  ASSERT_TRUE(high);
  FreeSpace space = this->space();
  base::Budget budget(kStepsOfChoice);
  const Relaxed low = relaxed(problem_, *high, Ends::kFixed, {}, budget, space, Deadline::never());
  EXPECT_LT(cost(low), 0.6 * cost(*high));
  const double height_m = low.candidate.path.at(4.0).position.y();
  EXPECT_GT(height_m, kHeight_m);
  EXPECT_LT(height_m, 0.5 * (kHeight_m + kTooHigh_m));
}

}  // namespace
}  // namespace camway::correction
