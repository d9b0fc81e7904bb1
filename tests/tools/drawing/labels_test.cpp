// SPDX-License-Identifier: MIT
#include "tools/drawing/labels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random.h"
#include "tests/tools/drawing/drawn_house.h"
#include "tools/drawing/axes.h"

namespace camway::draw {
namespace {

/// Labels overlap neither each other nor marks, stay in the frame, and stand beside their marks.
TEST(LabelPlacer, LabelsDoNotOverlap) {
  constexpr double kMark_px = 5.0;
  testing::Random random(kDrawSeed);
  std::size_t placed = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Frame frame{random.uniform(-50, 50), 20, random.uniform(100, 600), 300};
    LabelPlacer places(frame);
    std::vector<PlanPoint> marks;
    for (int i = random.integer(1, 40); i > 0; --i) {
      marks.emplace_back(frame.x + random.uniform(0, frame.width), random.uniform(20, 320));
      places.block(marks.back(), kMark_px);
    }
    std::vector<PlanBox> boxes;
    for (const PlanPoint& mark : marks) {
      const PlanPoint size(random.uniform(8, 70), 13);
      const std::optional<PlanBox> box = places.place(mark, size);
      if (!box) continue;
      ++placed;
      EXPECT_LT((box->sizes() - size).norm(), 1e-9);
      EXPECT_LT(box->exteriorDistance(mark), 40.0);
      EXPECT_GE(box->min().x(), frame.x);
      EXPECT_LE(box->max().x(), frame.x + frame.width);
      for (const PlanBox& other : boxes) EXPECT_FALSE(other.intersects(*box));
      for (const PlanPoint& other : marks) {
        EXPECT_GT((box->center() - other).cwiseAbs().x() - size.x() / 2 < kMark_px
                      ? (box->center() - other).cwiseAbs().y() - size.y() / 2
                      : kMark_px + 1,
                  kMark_px);
      }
      boxes.push_back(*box);
    }
  }
  EXPECT_GT(placed, 2000U);
}

/// Ticks are round, even, increasing, within the axis, and neither too many nor too few.
TEST(Axes, TicksAreRound) {
  testing::Random random(kDrawSeed);
  for (int trial = 0; trial < 2000; ++trial) {
    const double begin = random.uniform(-1, 1) * random.log_uniform(1e-3, 1e5);
    const double range = random.log_uniform(1e-2, 1e4);
    const auto most = static_cast<std::size_t>(random.integer(3, 20));
    const bool turned = random.chance(0.5);
    const Axis axis{turned ? begin + range : begin, turned ? begin : begin + range, ""};
    const std::vector<double> values = ticks(axis, most);
    ASSERT_LE(values.size(), most);
    // The next smaller step, at least two fifths as large, would have given too many.
    ASSERT_GE(static_cast<double>(values.size()), 0.4 * static_cast<double>(most - 1) - 1.0);
    for (std::size_t i = 0; i + 1 < values.size(); ++i) {
      const double step = values[i + 1] - values[i];
      ASSERT_GT(step, 0.0);
      const double leading = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
      ASSERT_TRUE(std::abs(leading - 1) < 1e-6 || std::abs(leading - 2) < 1e-6 ||
                  std::abs(leading - 5) < 1e-6)
          << step;
    }
    for (const double value : values) {
      ASSERT_GE(value, begin - 1e-9 * range);
      ASSERT_LE(value, begin + range * (1 + 1e-9));
    }
  }
  EXPECT_TRUE(ticks({1, 1, ""}, 5).empty());
}

}  // namespace
}  // namespace camway::draw
