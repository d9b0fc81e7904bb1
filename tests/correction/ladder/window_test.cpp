// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/window.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/gap_problems.h"

namespace camway::correction {
namespace {

std::vector<double> times_of(const motion::KnotRow& knots) {
  std::vector<double> times_s;
  for (int k = 0; k <= knots.count; ++k) times_s.push_back(knots.knot_s(k));
  return times_s;
}

Problem problem_of(const std::vector<double>& times_s, std::size_t leg) {
  std::vector<motion::Keyframe> keyframes;
  for (const double time_s : times_s) {
    keyframes.push_back({time_s, {{time_s, 0, 0}, geometry::Quat::Identity()}});
  }
  return testing::problem_of_leg(keyframes, leg);
}

TEST(Window, IsFourStepsAboutAShortCollisionInTheOpen) {
  const Problem problem = problem_of({0, 20}, 0);
  EXPECT_EQ(times_of(window_about(problem, 9.9, 10.1, 1.0)),
            (std::vector<double>{8, 9, 10, 11, 12}));
}

TEST(Window, HasKnotsAlongALongCollision) {
  const Problem problem = problem_of({0, 20}, 0);
  EXPECT_EQ(times_of(window_about(problem, 9, 11, 1.0)),
            (std::vector<double>{7, 8, 9, 10, 11, 12, 13}));
}

TEST(Window, EndsAtAKeyframeThatIsNotFar) {
  const Problem problem = problem_of({0, 20}, 0);
  EXPECT_EQ(times_of(window_about(problem, 2.4, 2.4, 1.0)),
            (std::vector<double>{0, 1.2, 2.4, 3.4, 4.4}));
}

TEST(Window, GoesOnBeyondANearKeyframe) {
  const Problem problem = problem_of({0, 10, 30}, 1);
  EXPECT_EQ(times_of(window_about(problem, 11, 11, 1.0)),
            (std::vector<double>{8, 9, 10, 11, 12, 13}));
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
