// SPDX-License-Identifier: MIT
#include "daemon/service/watches/answer_quality.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <vector>

#include <camway/plan_request_t.hpp>

#include "tests/support/random.h"

namespace camway::service {
namespace {

AnswerQuality with(double length_m, double deviation_m, double clearance_m = 1.0) {
  AnswerQuality quality;
  quality.measures.length_m = length_m;
  quality.measures.largest_deviation_m = deviation_m;
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
  EXPECT_FALSE(is_better(with(4, 0.0), with(4, 0.9e-3), plan_request_t::CLOSEST)) << "0.9 mm";
  EXPECT_TRUE(is_better(with(4, 0.0), with(4, 1.1e-3), plan_request_t::CLOSEST)) << "1.1 mm";
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
    return quality;
  };
  int better = 0;
  for (int trial = 0; trial < 20'000; ++trial) {
    const AnswerQuality a = any();
    const AnswerQuality b = any();
    const auto objective = static_cast<std::int8_t>(trial % 4);
    better += is_better(a, b, objective) ? 1 : 0;
    ASSERT_FALSE(is_better(a, b, objective) && is_better(b, a, objective)) << trial;
    ASSERT_FALSE(is_better(a, a, objective)) << trial;
  }
  EXPECT_GT(better, 5'000);
}

}  // namespace
}  // namespace camway::service
