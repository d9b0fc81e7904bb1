// SPDX-License-Identifier: MIT
#include "tools/json/json_options.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <string>

#include "tests/support/random.h"
#include "tools/json/json_angle.h"

namespace camway::tools {
namespace {

using correction::Objective;
using correction::OrientationRule;
using planning::PlanOptions;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Parsed<PlanOptions> options_of(const std::string& text) {
  return parse_as(read_options, text, "R.json");
}

TEST(JsonOptions, ReadsEveryField) {
  const auto parsed = options_of(R"({
    "method": "ladder", "objective": "smoothest",
    "orientation": {"policy": "target", "target": [1, 2, 3], "cone_deg": 30, "max_turn_deg": 90},
    "limits": {"speed": 1.5, "acceleration": 2.5, "turn_rate_deg": 180, "retime": true},
    "bounds": {"min": [null, -0.5, 0], "max": [3, null, null]},
    "max_shrink": 0.25, "repair_keyframes": true, "seed": 42})");
  ASSERT_TRUE(parsed.value) << parsed.error;
  const PlanOptions& options = *parsed.value;
  EXPECT_EQ(options.method, planning::Method::kLadder);
  EXPECT_EQ(options.objective, Objective::kSmoothest);
  EXPECT_EQ(options.orientation.rule, OrientationRule::kTarget);
  EXPECT_EQ(options.orientation.target_W, geometry::Vec3(1, 2, 3));
  EXPECT_DOUBLE_EQ(options.orientation.cone_rad, std::numbers::pi / 6);
  EXPECT_DOUBLE_EQ(options.orientation.max_turn_rad, std::numbers::pi / 2);
  EXPECT_EQ(options.limits.speed_m_per_s, 1.5);
  EXPECT_EQ(options.limits.acceleration_m_per_s2, 2.5);
  EXPECT_EQ(options.limits.turn_rate_rad_per_s, std::numbers::pi);
  EXPECT_TRUE(options.limits.may_retime);
  EXPECT_EQ(options.bounds.min_W.tail<2>(), Eigen::Vector2d(-0.5, 0.0));
  EXPECT_EQ(options.bounds.max_W.x(), 3.0);
  EXPECT_TRUE(std::isinf(options.bounds.min_W.x()));
  EXPECT_TRUE(std::isinf(options.bounds.max_W.y()) && std::isinf(options.bounds.max_W.z()));
  EXPECT_EQ(options.max_shrink, 0.25);
  EXPECT_TRUE(options.repair_keyframes);
  EXPECT_EQ(options.seed, 42U);
}

TEST(JsonOptions, HasDefaultsForAllThatMayBeMissing) {
  EXPECT_EQ(options_of("{}").value, PlanOptions{});
  EXPECT_EQ(options_of(R"({"orientation": {}})").value, planning::PlanOptions{});
  EXPECT_EQ(options_of(R"({"bounds": {}})").value, planning::PlanOptions{});
  const auto parsed = options_of(R"({"orientation": {"max_turn_deg": 90}})");
  ASSERT_TRUE(parsed.value) << parsed.error;
  EXPECT_EQ(parsed.value->orientation.rule, correction::OrientationRule::kFree);
  EXPECT_NEAR(parsed.value->orientation.max_turn_rad, std::numbers::pi / 2, 1e-15);
  EXPECT_EQ(options_of(R"({"orientation": {"policy": "free"}, "limits": {}})").value,
            PlanOptions{});
}

TEST(JsonOptions, DirectionsNeedNotBeOfUnitLength) {
  const auto parsed = options_of(R"({"orientation": {"policy": "level", "up": [0, 0, 1e-200]}})");
  ASSERT_TRUE(parsed.value) << parsed.error;
  EXPECT_EQ(parsed.value->orientation.rule, OrientationRule::kLevel);
  EXPECT_EQ(parsed.value->orientation.up_W, geometry::Vec3::UnitZ());
}

TEST(JsonOptions, HalfATurnIsTheMost) {
  const auto parsed = options_of(R"({"orientation": {"policy": "target", "target": [0, 0, 0],
                                     "cone_deg": 180, "max_turn_deg": 180}})");
  ASSERT_TRUE(parsed.value) << parsed.error;
  EXPECT_LE(parsed.value->orientation.cone_rad, std::numbers::pi);
  EXPECT_LE(parsed.value->orientation.max_turn_rad, std::numbers::pi);
}

TEST(JsonOptions, NamesTheFieldAtFault) {
  const struct {
    const char* options;
    const char* expected;
  } cases[] = {
      {R"({"objective": "cheapest"})",
       "objective: 'cheapest' is unknown; there are closest, shortest, smoothest, safest"},
      {R"({"objective": 1})", "objective: must be a string"},
      {R"({"orientation": "free"})", "orientation: must be an object"},
      {R"({"orientation": {"policy": "upside"}})",
       "orientation.policy: 'upside' is unknown; there are free, keep, level, target"},
      {R"({"orientation": {"policy": "free", "turn": 3}})", "orientation.turn: is unknown"},
      {R"({"orientation": {"policy": "level", "up": [0, 1]}})", "orientation.up: must be an array"},
      {R"({"orientation": {"policy": "keep", "up": [0, 1, 0]}})",
       "orientation.up: counts only with \"policy\": \"level\""},
      {R"({"orientation": {"policy": "target"}})", "orientation.target: is missing"},
      {R"({"orientation": {"policy": "level", "target": [0, 1, 0]}})",
       "orientation.target: counts only with \"policy\": \"target\""},
      {R"({"orientation": {"policy": "free", "cone_deg": 3}})",
       "orientation.cone_deg: counts only with"},
      {R"({"orientation": {"policy": "free", "max_turn_deg": "x"}})",
       "orientation.max_turn_deg: must be a number"},
      {R"({"limits": {"speed_m": 1}})", "limits.speed_m: is unknown"},
      {R"({"limits": {"speed": null}})", "limits.speed: must be a number"},
      {R"({"limits": {"retime": 1}})", "limits.retime: must be true or false"},
      {R"({"bounds": [1, 2, 3]})", "bounds: must be an object"},
      {R"({"bounds": {"low": [1, 2, 3]}})", "bounds.low: is unknown"},
      {R"({"bounds": {"min": [1, 2]}})", "bounds.min: must be an array of 3"},
      {R"({"bounds": {"min": [1, 2, 3, 4]}})", "bounds.min: must be an array of 3"},
      {R"({"bounds": {"max": [1, "2", 3]}})", "bounds.max[1]: must be a number"},
      {R"({"max_shrink": "much"})", "max_shrink: must be a number"},
      {R"({"repair_keyframes": 1})", "repair_keyframes: must be true or false"},
      {R"({"seed": 0})", "seed: must be a whole number from 1"},
      {R"({"seed": -4})", "seed: must be a whole number from 1"},
      {R"({"seed": 1.5})", "seed: must be a whole number from 1"},
  };
  for (const auto& c : cases) {
    const auto parsed = options_of(c.options);
    EXPECT_FALSE(parsed.value) << c.options;
    EXPECT_THAT(parsed.error, StartsWith(std::string("R.json: ") + c.expected));
  }
}

/// Returns the text of options with every field, as a client might write it.
std::string text_of(const PlanOptions& options) {
  const correction::OrientationPolicy& orientation = options.orientation;
  std::string policy = R"("policy": "free")";
  if (orientation.rule == OrientationRule::kKeep) policy = R"("policy": "keep")";
  if (orientation.rule == OrientationRule::kLevel) {
    const geometry::Vec3& up = orientation.up_W;
    policy = fmt::format(R"("policy": "level", "up": [{}, {}, {}])", up.x(), up.y(), up.z());
  }
  if (orientation.rule == OrientationRule::kTarget) {
    const geometry::Vec3& at = orientation.target_W;
    policy = fmt::format(R"("policy": "target", "target": [{}, {}, {}], "cone_deg": {})", at.x(),
                         at.y(), at.z(), degrees(orientation.cone_rad));
  }
  return fmt::format(
      R"({{"objective": "{}", "orientation": {{{}, "max_turn_deg": {}}},
          "limits": {{"speed": {}, "acceleration": {}, "turn_rate_deg": {}, "retime": {}}},
          "max_shrink": {}, "repair_keyframes": {}, "seed": {}}})",
      kObjectives[static_cast<std::size_t>(options.objective)].first, policy,
      degrees(orientation.max_turn_rad), options.limits.speed_m_per_s,
      options.limits.acceleration_m_per_s2, degrees(options.limits.turn_rate_rad_per_s),
      options.limits.may_retime, options.max_shrink, options.repair_keyframes, options.seed);
}

TEST(JsonOptions, WhatIsWrittenIsReadBitForBit) {
  constexpr unsigned kSeed = 2026;
  testing::Random random(kSeed);
  std::uniform_real_distribution<double> number(-50, 50);
  const auto angle = [&] { return radians(std::abs(number(random))); };
  for (int i = 0; i < 2000; ++i) {
    PlanOptions options;
    options.objective = static_cast<Objective>(random() % 4);
    options.orientation.rule = static_cast<OrientationRule>(random() % 4);
    const geometry::Vec3 at(number(random), number(random), number(random));
    if (options.orientation.rule == OrientationRule::kLevel) {
      options.orientation.up_W = planning::direction_of(at);
    }
    if (options.orientation.rule == OrientationRule::kTarget) {
      options.orientation.target_W = at;
      options.orientation.cone_rad = angle();
    }
    options.orientation.max_turn_rad = angle();
    options.limits = {std::abs(number(random)), std::abs(number(random)), angle(),
                      random() % 2 == 0};
    options.max_shrink = std::abs(number(random)) / 50;
    options.repair_keyframes = random() % 2 == 0;
    options.seed = 1 + random() % std::numeric_limits<std::int64_t>::max();
    const auto parsed = options_of(text_of(options));
    ASSERT_TRUE(parsed.value) << parsed.error;
    ASSERT_EQ(*parsed.value, options) << "trial " << i;
  }
}

TEST(JsonOptions, EveryObjectiveHasItsName) {
  for (std::size_t i = 0; i < kObjectives.size(); ++i) {
    EXPECT_EQ(kObjectives[i].second, static_cast<Objective>(i));
  }
}

TEST(JsonOptions, TheSpeedOfDerivedTimesIsRead) {
  EXPECT_EQ(options_of(R"({"default_speed_m_per_s": 2.5})").value->default_speed_m_per_s, 2.5);
  EXPECT_FALSE(options_of("{}").value->default_speed_m_per_s);
}

}  // namespace
}  // namespace camway::tools
