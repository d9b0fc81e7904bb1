// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "daemon/correction/path/closeness.h"
#include "daemon/correction/smoothing/relaxation.h"
#include "tests/support/gap_problems.h"

namespace camway::correction {
namespace {

using base::Deadline;
using geometry::Vec3;

/// The two terms of the cost of a correction.
struct CostTerms {
  double shift = 0.0;
  double acceleration = 0.0;

  [[nodiscard]] double sum() const { return shift + acceleration; }
  /// The acceleration for a shift: the same for all heights of a correction of this form.
  [[nodiscard]] double relative() const { return acceleration / (shift * shift); }
};

/// A path along z over a bar, corrected by a row of three coefficients.
class GentleStepsTest : public ::testing::Test {
 protected:
  GentleStepsTest() {
    testing::add_plate_across(mesh_, 0.3, 0.1);
    index_ = scene::SceneIndex::build(mesh_);
    problem_ = testing::problem_along_z();
  }

  [[nodiscard]] FreeSpace space() const {
    OrientationPolicy keep;
    keep.rule = OrientationRule::kKeep;
    return FreeSpace({collision::Obstacles(index_), body_, {}}, keep, closeness_);
  }

  /// Returns the row with these coefficients.
  static Offsets row(double outer_m, double middle_m) {
    constexpr double kBegin_s = 1.6;
    constexpr double kEnd_s = 6.4;
    Offsets offsets{{kBegin_s, kEnd_s, 6}, 2, {}};
    for (const double y_m : {outer_m, middle_m, outer_m}) {
      offsets.at.push_back({{0, y_m, 0}, geometry::Vec4::Zero()});
    }
    return offsets;
  }

  [[nodiscard]] std::optional<Relaxed> drawn(const Offsets& offsets) const {
    FreeSpace space = this->space();
    std::optional<Candidate> found =
        free_candidate(problem_, {bumps_for(offsets, Ends::kFixed)}, space, Deadline::never());
    if (!found) return std::nullopt;
    return Relaxed{offsets, *std::move(found)};
  }

  [[nodiscard]] CostTerms terms_of(const Relaxed& drawn) const {
    const motion::CubicPath& path = drawn.candidate.path;
    const double shift =
        shift_of(path, problem_.original, closeness_).mean_rad * (path.end_s() - path.begin_s());
    return {shift, closeness_cost(path, problem_.original, closeness_) - shift};
  }

  /// The lowest free row of this form.
  [[nodiscard]] std::optional<Relaxed> lowest(double outer_share) const {
    constexpr int kHalvings = 12;
    double below_m = 0.0;
    double above_m = 2.0;
    std::optional<Relaxed> least = drawn(row(outer_share * above_m, above_m));
    for (int i = 0; least && i < kHalvings; ++i) {
      const double middle_m = 0.5 * (below_m + above_m);
      std::optional<Relaxed> lower = drawn(row(outer_share * middle_m, middle_m));
      (lower ? above_m : below_m) = middle_m;
      if (lower) least = std::move(lower);
    }
    return least;
  }

  /// The cheapest row, by trying all forms.
  [[nodiscard]] CostTerms cheapest() const {
    CostTerms best{std::numeric_limits<double>::infinity(), 0.0};
    for (double outer_share = -0.4; outer_share < 1.2; outer_share += 0.02) {
      const std::optional<Relaxed> low = lowest(outer_share);
      if (low && terms_of(*low).sum() < best.sum()) best = terms_of(*low);
    }
    return best;
  }

  scene::Mesh mesh_;
  scene::SceneIndex index_;
  motion::Body body_{testing::small_camera()};
  Closeness closeness_{
      .viewing_distance_m = 3.0, .turn_lever_m = 3.0, .acceleration_m_per_s2 = 0.7};
  Problem problem_;
};

// Near its minimum the cost hardly changes, but the acceleration does.
TEST_F(GentleStepsTest, LowerTheAccelerationForLittleCost) {
  std::optional<Relaxed> relaxed = drawn(row(0.8, 0.8));
  ASSERT_TRUE(relaxed);
  for (int i = 0; i < 4; ++i) {
    FreeSpace space = this->space();
    base::Budget budget(100);
    relaxed = correction::relaxed(problem_, *std::move(relaxed), Ends::kFixed, {}, budget, space,
                                  Deadline::never());
  }
  const CostTerms cheapest = this->cheapest();
  const CostTerms ours = terms_of(*relaxed);
  EXPECT_LT(ours.relative(), 0.9 * cheapest.relative());
  EXPECT_LT(ours.sum(), 1.1 * cheapest.sum()) << "it keeps a gap as well";
}

}  // namespace
}  // namespace camway::correction
