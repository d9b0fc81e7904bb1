// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/knot_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/gap_problems.h"

namespace camway::correction {
namespace {

using motion::CubicPath;
using testing::Draw;

/// A tour, a changed part of it, and the path there with a row of bumps on `knots_s`.
struct ChoiceCase {
  Problem problem;
  ChangedPart part;
  std::vector<double> knots_s;
  CubicPath path;
};

/// Keyframes every 10 s, from 0 to 40 s, and a row on the knots.
ChoiceCase case_on(std::vector<double> knots_s) {
  std::vector<motion::Keyframe> keyframes;
  for (const double time_s : {0.0, 10.0, 20.0, 30.0, 40.0}) {
    keyframes.push_back({time_s, {{time_s, std::sin(time_s), 0}, geometry::Quat::Identity()}});
  }
  ChoiceCase c;
  c.problem.path = motion::interpolate_cubic(keyframes);
  c.problem.original = c.problem.path;
  for (const motion::Keyframe& keyframe : keyframes) {
    c.problem.keyframes_s.push_back(keyframe.time_s);
  }
  c.problem.has_path_begin = true;
  c.problem.has_path_end = true;
  c.part = {knots_s.front(), knots_s.back()};
  const FreeCoefficients free(c.problem, motion::KnotRow::at(knots_s, nullptr), Ends::kFixed);
  StackedPoints variables = StackedPoints::Zero(free.size(), 7);
  for (Eigen::Index i = 0; i < free.size(); ++i)
    variables(i, 2) = 1.0 + 0.3 * std::cos(3.0 * double(i));
  c.path = motion::with_bumps(
      c.problem.path, std::vector{bumps_for(free.offsets_of(variables, 1.0), Ends::kFixed)});
  c.knots_s = std::move(knots_s);
  return c;
}

bool has(const std::vector<double>& list_s, double time_s) {
  return std::ranges::find(list_s, time_s) != list_s.end();
}

TEST(KnotChoice, OnlyListsThatKeepKeyframesAreValid) {
  const ChoiceCase c = case_on({12, 13, 14, 15, 16});
  const KnotChoice choice(c.problem, c.part);
  EXPECT_TRUE(choice.is_valid({12, 13, 14, 15, 16}));
  EXPECT_TRUE(choice.is_valid({10, 13, 14, 15, 20})) << "keyframes at the ends";
  EXPECT_TRUE(choice.is_valid({8, 9, 10, 11, 12}));
  EXPECT_FALSE(choice.is_valid({12, 13, 14, 15})) << "no bump";
  EXPECT_FALSE(choice.is_valid({9, 10, 11, 12, 13})) << "a keyframe beside the end";
  EXPECT_FALSE(choice.is_valid({11, 12, 13, 20, 21}));
  EXPECT_FALSE(choice.is_valid({8, 9, 10, 20, 21, 22})) << "neighbours";
  EXPECT_TRUE(choice.is_valid({8, 9, 10, 15, 20, 21, 22}));
}

TEST(KnotChoice, TakesTheJointsOfThePart) {
  const ChoiceCase c = case_on({8, 9, 10, 11, 12, 14});
  EXPECT_EQ(KnotChoice(c.problem, c.part).knots_of(c.path), c.knots_s);
}

TEST(KnotChoice, GoesOnBeyondAnEndOfThePath) {
  const ChoiceCase c = case_on({36, 37, 38, 39, 40});
  EXPECT_EQ(KnotChoice(c.problem, c.part).knots_of(c.path),
            (std::vector<double>{36, 37, 38, 39, 40, 41, 42, 43}));
}

TEST(KnotChoice, ExtendsByOneStepWhereThereIsRoom) {
  const ChoiceCase c = case_on({14, 15, 16, 17, 18});
  const KnotChoice choice(c.problem, c.part);
  EXPECT_EQ(choice.extended(c.knots_s, 12.0, 20.0),
            (std::vector<double>{13, 14, 15, 16, 17, 18, 19}));
  EXPECT_EQ(choice.extended(c.knots_s, 13.25, 18.75),
            (std::vector<double>{13.25, 14, 15, 16, 17, 18, 18.75}));
  EXPECT_EQ(choice.extended(c.knots_s, 13.75, 18.25), c.knots_s);
}

// A knot is set at the keyframe, and the list stays valid.
TEST(KnotChoice, ExtendsBeyondAKeyframe) {
  const ChoiceCase c = case_on({10.5, 12, 13.5, 15, 16.5});
  const KnotChoice choice(c.problem, c.part);
  const std::vector<double> longer_s = choice.extended(c.knots_s, 5.0, 25.0);
  EXPECT_TRUE(has(longer_s, 10.0));
  EXPECT_LT(longer_s.front(), 10.0);
  EXPECT_TRUE(choice.is_valid(longer_s));
  for (const double knot_s : c.knots_s) EXPECT_TRUE(has(longer_s, knot_s)) << knot_s;
}

TEST(KnotChoice, ExtendsNotBeyondAnEndOfThePath) {
  const ChoiceCase c = case_on({36, 37, 38, 39, 40});
  const KnotChoice choice(c.problem, c.part);
  EXPECT_EQ(choice.extended({36, 37, 38, 39, 40, 41, 42, 43}, 34.0, 40.0),
            (std::vector<double>{35, 36, 37, 38, 39, 40, 41, 42, 43}));
}

TEST(KnotChoice, TrimsWhatChangesNothing) {
  ChoiceCase c = case_on({14, 15, 16, 17, 18});
  const KnotChoice choice(c.problem, c.part);
  EXPECT_EQ(choice.trimmed({11, 12, 13, 14, 15, 16, 17, 18, 19}, c.path), c.knots_s);
  EXPECT_EQ(choice.trimmed(c.knots_s, c.path), c.knots_s);
  const std::vector<double> more_s = {13, 14, 15, 16, 17, 18};
  EXPECT_EQ(choice.trimmed(more_s, c.problem.path), more_s) << "nothing is changed at all";
  c.part.turns = true;
  EXPECT_EQ(KnotChoice(c.problem, c.part).trimmed(more_s, c.path), more_s);
}

// The row changes little before 10 s, and much until 17 s.
TEST(KnotChoice, CutsAtAKeyframeBeyondWhichLittleChanges) {
  const std::vector<double> knots_s = {6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17};
  ChoiceCase c = case_on(knots_s);
  const FreeCoefficients free(c.problem, motion::KnotRow::at(knots_s, nullptr), Ends::kFixed);
  const auto path_with = [&](double early_m) {
    StackedPoints variables = StackedPoints::Zero(free.size(), 7);
    variables(0, 2) = early_m;
    variables(free.size() - 2, 2) = 1.0;
    return motion::with_bumps(
        c.problem.path, std::vector{bumps_for(free.offsets_of(variables, 1.0), Ends::kFixed)});
  };
  const KnotChoice choice(c.problem, c.part);
  EXPECT_EQ(choice.cut_at_keyframes(knots_s, path_with(0.1)),
            (std::vector<double>{10, 11, 12, 13, 14, 15, 16, 17}));
  EXPECT_EQ(choice.cut_at_keyframes(knots_s, path_with(0.9)), knots_s);
  c.part.turns = true;
  EXPECT_EQ(KnotChoice(c.problem, c.part).cut_at_keyframes(knots_s, path_with(0.1)), knots_s);
}

// A knot at which nothing happens goes first.
TEST(KnotChoice, RemovesFirstWhatMattersLeast) {
  ChoiceCase c = case_on({11, 12, 13, 14, 15, 16, 17});
  std::vector<double> more_s = c.knots_s;
  more_s.insert(more_s.begin() + 3, 13.5);
  const std::vector<std::size_t> removable =
      KnotChoice(c.problem, c.part).removable(more_s, c.path);
  ASSERT_FALSE(removable.empty());
  EXPECT_EQ(more_s[removable.front()], 13.5);
  for (const std::size_t i : removable) {
    for (const std::size_t other : removable) EXPECT_NE(i, other + 1) << "neighbours";
  }
}

TEST(KnotChoice, LeavesAValidListWithoutAnyOneOfTheRemovable) {
  Draw draw(7501);
  int removed = 0;
  for (int run = 0; run < 300; ++run) {
    std::vector<double> knots_s = {draw.uniform(0.5, 9.0)};
    while (knots_s.back() < 34.0) knots_s.push_back(knots_s.back() + draw.uniform(0.3, 2.5));
    for (const double keyframe_s : {10.0, 20.0, 30.0}) {
      if (knots_s.front() < keyframe_s && keyframe_s < knots_s.back()) {
        knots_s.insert(std::ranges::lower_bound(knots_s, keyframe_s), keyframe_s);
      }
    }
    ChoiceCase c = case_on(knots_s);
    const KnotChoice choice(c.problem, c.part);
    if (!choice.is_valid(knots_s)) continue;
    for (const std::size_t i : choice.removable(knots_s, c.path)) {
      std::vector<double> left_s = knots_s;
      left_s.erase(left_s.begin() + static_cast<std::ptrdiff_t>(i));
      ASSERT_TRUE(choice.is_valid(left_s)) << run;
      ASSERT_FALSE(std::ranges::binary_search(c.problem.keyframes_s, knots_s[i]));
      ++removed;
    }
  }
  EXPECT_GT(removed, 500);
}

}  // namespace
}  // namespace camway::correction
