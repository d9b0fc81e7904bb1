// SPDX-License-Identifier: MIT
#include "daemon/service/watches/answer_quality.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include <camway/plan_request_t.hpp>

#include "tests/support/random.h"

namespace camway::service {
namespace {

/// Share of its path that a correction takes in these tests, times the mean of its shape.
constexpr double kChangedShare = 0.25;

/// Returns the quality of an answer that moves and does not turn, seen from a metre away.
AnswerQuality with(double length_m, double deviation_m, double clearance_m = 1.0) {
  AnswerQuality quality;
  quality.measures.length_m = length_m;
  quality.measures.largest_deviation_m = deviation_m;
  quality.measures.largest_shift_rad = deviation_m;
  quality.measures.mean_shift_rad = kChangedShare * deviation_m;
  quality.measures.bending_energy_m2_per_s3 = 10.0 * deviation_m;
  quality.measures.clearance_lower_bound_m = clearance_m;
  return quality;
}

TEST(AnswerQuality, GoesByTheRequestsObjective) {
  const AnswerQuality straight = with(4.0, 0.0, 0.2);
  const AnswerQuality detour = with(4.5, 0.6, 0.8);
  for (const std::int8_t objective : std::vector<std::int8_t>{
           plan_request_t::CLOSEST, plan_request_t::SHORTEST, plan_request_t::SMOOTHEST}) {
    EXPECT_TRUE(is_better(straight, detour, objective)) << int(objective);
    EXPECT_FALSE(is_better(detour, straight, objective)) << int(objective);
  }
  EXPECT_TRUE(is_better(detour, straight, plan_request_t::SAFEST));
  EXPECT_FALSE(is_better(straight, detour, plan_request_t::SAFEST));
  EXPECT_TRUE(is_better(with(4.0, 0.0), with(4.5, 0.6), plan_request_t::SAFEST))
      << "as safe, and closer";
}

TEST(AnswerQuality, NeedsAMargin) {
  EXPECT_FALSE(is_better(with(3.97, 0), with(4.0, 0), plan_request_t::SHORTEST)) << "0.75 %";
  EXPECT_TRUE(is_better(with(3.95, 0), with(4.0, 0), plan_request_t::SHORTEST)) << "1.25 %";
  EXPECT_FALSE(is_better(with(0.0491, 0), with(0.05, 0), plan_request_t::SHORTEST)) << "0.9 mm";
  EXPECT_TRUE(is_better(with(0.0489, 0), with(0.05, 0), plan_request_t::SHORTEST)) << "1.1 mm";
}

/// Returns the quality of an answer whose picture shifts like this, and whose eye does not move.
AnswerQuality turned(double largest_rad, double mean_rad) {
  AnswerQuality quality = with(4.0, 0.0);
  quality.measures.largest_shift_rad = largest_rad;
  quality.measures.mean_shift_rad = mean_rad;
  return quality;
}

TEST(AnswerQuality, ATurnIsFartherThanNone) {
  const AnswerQuality kept = with(4.0, 0.0);
  const AnswerQuality turns = turned(0.1, 0.02);
  for (const std::int8_t objective : {plan_request_t::CLOSEST, plan_request_t::SAFEST}) {
    EXPECT_TRUE(is_better(kept, turns, objective)) << int(objective);
    EXPECT_FALSE(is_better(turns, kept, objective)) << int(objective);
  }
  // A small move is better than a large turn, although the eye deviates.
  EXPECT_TRUE(is_better(with(4.0, 0.02), turns, plan_request_t::CLOSEST));
  EXPECT_FALSE(is_better(turns, with(4.0, 0.02), plan_request_t::CLOSEST));
  const QualityGain gain = gain_of(kept, turns, plan_request_t::CLOSEST);
  EXPECT_EQ(gain.what, "mean shift");
  EXPECT_NEAR(gain.before, 0.02 * 180.0 / std::numbers::pi, 1e-12);
  EXPECT_EQ(gain.now, 0.0);
}

TEST(AnswerQuality, TheMeanShiftDecidesAndNotTheLargest) {
  EXPECT_TRUE(is_better(turned(0.11, 0.02), turned(0.1, 0.03), plan_request_t::CLOSEST));
  EXPECT_FALSE(is_better(turned(0.1, 0.03), turned(0.11, 0.02), plan_request_t::CLOSEST));
}

// The margin of shifts is that of lengths in the part that was corrected, however long the path is.
TEST(AnswerQuality, TheMarginOfShiftsDoesNotHangOnTheLengthOfThePath) {
  const auto closest = plan_request_t::CLOSEST;
  for (const double share : {0.5, 1e-2, 1e-6}) {
    const auto shifted = [share](double largest_rad) {
      return turned(largest_rad, share * largest_rad);
    };
    EXPECT_FALSE(is_better(turned(0, 0), shifted(0.9 * kBetterShift_rad), closest)) << share;
    EXPECT_TRUE(is_better(turned(0, 0), shifted(1.1 * kBetterShift_rad), closest)) << share;
    const double most_rad = 5.0 * kBetterShift_rad;  // the floor is above 1 % of it
    EXPECT_FALSE(is_better(shifted(most_rad - 0.9 * kBetterShift_rad), shifted(most_rad), closest));
    EXPECT_TRUE(is_better(shifted(most_rad - 1.1 * kBetterShift_rad), shifted(most_rad), closest));
    EXPECT_FALSE(is_better(shifted(0.0993), shifted(0.1), closest)) << "0.7 %";
    EXPECT_TRUE(is_better(shifted(0.0985), shifted(0.1), closest)) << "1.5 %";
  }
}

/// Returns an answer with a correction that moves and turns by so much, and does not tell a shift.
plan_response_t untold(double moved_m, double turned_rad) {
  plan_response_t answer{};
  answer.measures.largest_deviation_m = moved_m;
  correction_t correction{};
  correction.moved_m = moved_m;
  correction.turned_rad = turned_rad;
  answer.corrections.push_back(correction);
  answer.num_corrections = 1;
  return answer;
}

TEST(AnswerQuality, AnswersWithoutAShiftAreComparedByTheirDeviation) {
  EXPECT_FALSE(AnswerQuality::of(untold(0.1, 0.0)).tells_shift);
  EXPECT_FALSE(AnswerQuality::of(untold(0.0, 0.1)).tells_shift);
  plan_response_t inserted = untold(0.1, 0.0);
  inserted.corrections.clear();
  EXPECT_FALSE(AnswerQuality::of(inserted).tells_shift) << "keyframe insertion";
  EXPECT_TRUE(AnswerQuality::of(plan_response_t{}).tells_shift) << "nothing was changed";
  EXPECT_TRUE(AnswerQuality::of(untold(1e-12, 0.0)).tells_shift) << "by rounding alone";
  plan_response_t told = untold(0.2, 0.0);
  told.measures.largest_shift_rad = 0.2;
  told.measures.mean_shift_rad = 0.05;
  EXPECT_TRUE(AnswerQuality::of(told).tells_shift);

  const auto gain = [](const plan_response_t& now, const plan_response_t& before) {
    return gain_of(AnswerQuality::of(now), AnswerQuality::of(before), plan_request_t::CLOSEST);
  };
  EXPECT_EQ(gain(told, untold(0.1, 0.0)).what, "deviation");
  EXPECT_LT(gain(told, untold(0.1, 0.0)).sign, 0);
  EXPECT_GT(gain(untold(0.1, 0.0), told).sign, 0);
  // An earlier answer that only turned must not look like one that changed nothing.
  told.measures.largest_deviation_m = 0.0;
  EXPECT_EQ(gain(told, untold(0.0, 0.1)).sign, 0);
}

TEST(AnswerQuality, WhatWasAskedForComesBeforeTheObjective) {
  const AnswerQuality whole = with(5.0, 1.0);
  for (const auto& spoil : std::vector<std::function<void(AnswerQuality&)>>{
           [](AnswerQuality& quality) { quality.repaired_keyframes = 1; },
           [](AnswerQuality& quality) { quality.near_scale = 0.5; },
           [](AnswerQuality& quality) { quality.time_scale = 1.5; }}) {
    AnswerQuality spoilt = with(4.0, 0.0);
    spoil(spoilt);
    EXPECT_TRUE(is_better(whole, spoilt, plan_request_t::SHORTEST));
    EXPECT_FALSE(is_better(spoilt, whole, plan_request_t::SHORTEST));
  }
}

TEST(AnswerQuality, NeverBothWays) {
  testing::Random random(20060619);
  std::uniform_real_distribution<double> number(0.0, 1.0);
  std::uniform_int_distribution<int> few(0, 1);
  const auto any = [&] {
    AnswerQuality quality = with(number(random), number(random), number(random));
    quality.repaired_keyframes = static_cast<std::size_t>(few(random));
    quality.near_scale = 1.0 - 0.1 * few(random);
    quality.time_scale = 1.0 + 0.1 * few(random);
    quality.tells_shift = few(random) == 0;
    // Near to the margin and far from it, and turns that no deviation tells of.
    quality.measures.largest_shift_rad *= few(random) == 0 ? 1.0 : kBetterShift_rad;
    quality.measures.mean_shift_rad = number(random) * quality.measures.largest_shift_rad;
    return quality;
  };
  int better = 0;
  for (int trial = 0; trial < 20'000; ++trial) {
    const AnswerQuality a = any();
    const AnswerQuality b = any();
    const auto objective = static_cast<std::int8_t>(trial % 4);
    better += is_better(a, b, objective) ? 1 : 0;
    ASSERT_EQ(gain_of(a, b, objective).sign, -gain_of(b, a, objective).sign) << trial;
    ASSERT_FALSE(is_better(a, a, objective)) << trial;
  }
  EXPECT_GT(better, 5'000);
}

}  // namespace
}  // namespace camway::service
