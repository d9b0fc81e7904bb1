// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/window.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "daemon/correction/path/closeness.h"
#include "tests/support/gap_problems.h"

namespace camway::correction {
namespace {

std::vector<double> times_of(const motion::KnotRow& knots) {
  std::vector<double> times_s;
  for (int k = 0; k <= knots.count; ++k) times_s.push_back(knots.knot_s(k));
  return times_s;
}

// Bound on the rounding of a few sums of times up to 30 s.
constexpr double kTimeRounding_s = 1e-12;

/// Expects a row with steps of these lengths from `begin_s` on.
void expect_steps(const motion::KnotRow& knots, double begin_s,
                  const std::vector<double>& steps_s) {
  const std::vector<double> times_s = times_of(knots);
  ASSERT_EQ(times_s.size(), steps_s.size() + 1);
  double expected_s = begin_s;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    EXPECT_NEAR(times_s[i], expected_s, kTimeRounding_s) << i;
    if (i < steps_s.size()) expected_s += steps_s[i];
  }
}

constexpr double kInner_s = 1.3;  // the steps of a row of spacing 1 s
constexpr double kOuter_s = kInner_s / 3.0;

Problem problem_of(const std::vector<double>& times_s, std::size_t leg) {
  std::vector<motion::Keyframe> keyframes;
  for (const double time_s : times_s) {
    keyframes.push_back({time_s, {{time_s, 0, 0}, geometry::Quat::Identity()}});
  }
  return testing::problem_of_leg(keyframes, leg);
}

TEST(Window, IsFourStepsAboutAShortCollisionInTheOpen) {
  const Problem problem = problem_of({0, 20}, 0);
  expect_steps(window_about(problem, 9.9, 10.1, 1.0), 10.0 - kInner_s - kOuter_s,
               {kOuter_s, kInner_s, kInner_s, kOuter_s});
}

TEST(Window, HasKnotsAlongALongCollision) {
  const Problem problem = problem_of({0, 20}, 0);
  expect_steps(window_about(problem, 9, 11, 1.0), 9.0 - kInner_s - kOuter_s,
               {kOuter_s, kInner_s, 1.0, 1.0, kInner_s, kOuter_s});
}

TEST(Window, EndsAtAKeyframeThatIsNotFar) {
  const Problem problem = problem_of({0, 20}, 0);
  expect_steps(window_about(problem, 2.4, 2.4, 1.0), 0.0, {1.2, 1.2, kInner_s, kOuter_s});
}

TEST(Window, GoesOnBeyondANearKeyframe) {
  const Problem problem = problem_of({0, 10, 30}, 1);
  expect_steps(window_about(problem, 11, 11, 1.0), 10.0 - kInner_s - kOuter_s,
               {kOuter_s, kInner_s, 1.0, kInner_s, kOuter_s});
}

/// Measures of a bump of some height.
struct BumpMeasures {
  double cost = 0.0;       ///< `closeness_cost` of a move
  double most_m_s2 = 0.0;  ///< largest acceleration
  double changed_s = 0.0;  ///< time in which it moves by more than a hundredth of its height
};

BumpMeasures measures_of(std::span<const double> knots_s, double height_m,
                         const Closeness& closeness) {
  constexpr int kTimes = 20000;
  std::array<double, 5> five_s{};
  std::ranges::copy(knots_s, five_s.begin());
  const motion::KnotBump bump(five_s);
  const double factor_m = height_m / bump.value(five_s[2]);
  const double step_s = (five_s[4] - five_s[0]) / kTimes;
  BumpMeasures measures;
  for (int i = 0; i < kTimes; ++i) {
    const double time_s = five_s[0] + (i + 0.5) * step_s;
    const double moved_m = factor_m * bump.value(time_s);
    const double acceleration = std::abs(factor_m * bump.second_derivative(time_s));
    measures.most_m_s2 = std::max(measures.most_m_s2, acceleration);
    measures.cost += step_s * moved_m / closeness.viewing_distance_m;
    measures.cost += step_s * kAccelerationWeight_rad *
                     std::pow(acceleration / closeness.acceleration_m_per_s2, 2.0);
    if (moved_m > 0.01 * height_m) measures.changed_s += step_s;
  }
  return measures;
}

// Short steps at the ends: beside a bump on equidistant knots, which costs least, the bump changes
// the path for less time and accelerates less.
TEST(Window, ShortEndsAreGentlerAndShorterAtTheSameCost) {
  const Problem problem = problem_of({0, 20}, 0);
  const Closeness closeness{.viewing_distance_m = 3.0, .acceleration_m_per_s2 = 0.7};
  for (const double height_m : {0.02, 0.1, 0.5}) {
    const double spacing_s = closeness.best_spacing_s(height_m);
    const std::vector<double> even_s = {10.0 - 2.0 * spacing_s, 10.0 - spacing_s, 10.0,
                                        10.0 + spacing_s, 10.0 + 2.0 * spacing_s};
    const BumpMeasures even = measures_of(even_s, height_m, closeness);
    const BumpMeasures ours =
        measures_of(times_of(window_about(problem, 10.0, 10.0, spacing_s)), height_m, closeness);
    EXPECT_LT(ours.cost, 1.02 * even.cost) << height_m;
    EXPECT_LT(ours.most_m_s2, 0.9 * even.most_m_s2) << height_m;
    EXPECT_LT(ours.changed_s, 0.93 * even.changed_s) << height_m;
  }
}

TEST(Window, HasEveryKeyframeWithinItAtAKnot) {
  testing::Draw draw(7401);
  for (int run = 0; run < 2000; ++run) {
    std::vector<double> keyframes_s = {0.0};
    for (int i = 0; i < 4; ++i) {
      keyframes_s.push_back(keyframes_s.back() + draw.uniform(0.1, 8.0));
    }
    const auto leg = static_cast<std::size_t>(draw.integer(0, 3));
    const Problem problem = problem_of(keyframes_s, leg);
    const double begin_s = draw.uniform(problem.leg_begin_s(), problem.leg_end_s());
    const double end_s = draw.uniform(begin_s, problem.leg_end_s());
    const std::vector<double> times_s =
        times_of(window_about(problem, begin_s, end_s, draw.uniform(0.1, 3.0)));
    ASSERT_GE(times_s.size(), 5u);
    ASSERT_TRUE(std::ranges::is_sorted(times_s));
    ASSERT_EQ(std::ranges::adjacent_find(times_s), times_s.end());
    for (const double keyframe_s : problem.keyframes_s) {
      if (times_s.front() < keyframe_s && keyframe_s < times_s.back()) {
        ASSERT_TRUE(std::ranges::binary_search(times_s, keyframe_s)) << run;
      }
    }
  }
}

}  // namespace
}  // namespace camway::correction
