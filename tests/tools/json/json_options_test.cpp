// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <type_traits>

#include "daemon/planning/request/option_table.h"
#include "tests/messages/plan_samples.h"
#include "tools/json/json_angle.h"
#include "tools/json/json_request.h"

namespace camway::tools {
namespace {

using correction::Objective;
using correction::OrientationRule;
using planning::FieldSpec;
using planning::PlanOptions;
using ::testing::HasSubstr;
using ::testing::StartsWith;

base::Result<PlanOptions> options_of(const std::string& text) {
  return parse_as<PlanOptions>(text, "R.json");
}

TEST(JsonOptions, ReadsEveryField) {
  const auto parsed = options_of(R"({
    "method": "ladder", "objective": "smoothest",
    "orientation": {"policy": "target", "target": [1, 2, 3], "cone_deg": 30, "max_turn_deg": 90},
    "limits": {"speed_m_per_s": 1.5, "acceleration_m_per_s2": 2.5, "turn_rate_deg_per_s": 180,
               "retime": true},
    "bounds": {"min": [null, -0.5, 0], "max": [3, null, null]},
    "max_shrink": 0.25, "repair_keyframes": true,
    "clearance_profile": true, "seed": 42})");
  ASSERT_TRUE(parsed) << parsed.error;
  const PlanOptions& options = *parsed;
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
  EXPECT_TRUE(options.clearance_profile);
  EXPECT_EQ(options.seed, 42U);
}

TEST(JsonOptions, ReadsTheOldNames) {
  const auto old_names = options_of(R"({"clearance": 0.25,
      "limits": {"speed": 1.5, "acceleration": 2.5, "turn_rate_deg": 180}})");
  const auto names = options_of(R"({"clearance_m": 0.25, "limits": {"speed_m_per_s": 1.5,
      "acceleration_m_per_s2": 2.5, "turn_rate_deg_per_s": 180}})");
  ASSERT_TRUE(old_names.value) << old_names.error;
  EXPECT_EQ(old_names.value, names.value);
  EXPECT_EQ(names.value->clearance_m, 0.25);
  EXPECT_EQ(names.value->limits.turn_rate_rad_per_s, std::numbers::pi);
}

TEST(JsonOptions, HasDefaultsForAllThatMayBeMissing) {
  EXPECT_EQ(options_of("{}").value, PlanOptions{});
  EXPECT_EQ(options_of(R"({"orientation": {}})").value, planning::PlanOptions{});
  EXPECT_EQ(options_of(R"({"bounds": {}})").value, planning::PlanOptions{});
  const auto parsed = options_of(R"({"orientation": {"max_turn_deg": 90}})");
  ASSERT_TRUE(parsed) << parsed.error;
  EXPECT_EQ(parsed->orientation.rule, correction::OrientationRule::kFree);
  EXPECT_NEAR(parsed->orientation.max_turn_rad, std::numbers::pi / 2, 1e-15);
  EXPECT_EQ(options_of(R"({"orientation": {"policy": "free"}, "limits": {}})").value,
            PlanOptions{});
}

TEST(JsonOptions, DirectionsNeedNotBeOfUnitLength) {
  const auto parsed = options_of(R"({"orientation": {"policy": "level", "up": [0, 0, 1e-200]}})");
  ASSERT_TRUE(parsed) << parsed.error;
  EXPECT_EQ(parsed->orientation.rule, OrientationRule::kLevel);
  EXPECT_EQ(parsed->orientation.up_W, geometry::Vec3::UnitZ());
}

TEST(JsonOptions, HalfATurnIsTheMost) {
  const auto parsed = options_of(R"({"orientation": {"policy": "target", "target": [0, 0, 0],
                                     "cone_deg": 180, "max_turn_deg": 180}})");
  ASSERT_TRUE(parsed) << parsed.error;
  EXPECT_LE(parsed->orientation.cone_rad, std::numbers::pi);
  EXPECT_LE(parsed->orientation.max_turn_rad, std::numbers::pi);
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
       "orientation.up: does not count with this policy; leave it out, or set the one it belongs "
       "to"},
      {R"({"orientation": {"policy": "target"}})", "orientation.target: is missing"},
      {R"({"orientation": {"policy": "level", "target": [0, 1, 0]}})",
       "orientation.target: does not count with this policy"},
      {R"({"orientation": {"policy": "free", "cone_deg": 3}})",
       "orientation.cone_deg: does not count with this policy"},
      {R"({"orientation": {"policy": "free", "max_turn_deg": "x"}})",
       "orientation.max_turn_deg: must be a number"},
      {R"({"limits": {"speed_m": 1}})", "limits.speed_m: is unknown"},
      {R"({"limits": {"speed_m_per_s": null}})", "limits.speed_m_per_s: must be a number"},
      {R"({"limits": {"speed": null}})", "limits.speed: must be a number"},
      {R"({"clearance": "wide"})", "clearance: must be a number"},
      {R"({"clearance_m": 1, "clearance": 1})",
       "has both clearance_m and clearance, its old name; leave one out"},
      {R"({"limits": {"speed": 1, "speed_m_per_s": 1}})",
       "limits: has both speed_m_per_s and speed, its old name"},
      {R"({"limits": {"acceleration": 1, "acceleration_m_per_s2": 1}})",
       "limits: has both acceleration_m_per_s2 and acceleration, its old name"},
      {R"({"limits": {"turn_rate_deg": 1, "turn_rate_deg_per_s": 1}})",
       "limits: has both turn_rate_deg_per_s and turn_rate_deg, its old name"},
      {R"({"limits": {"sped": 1}})",
       "limits.sped: is unknown; limits has speed_m_per_s, acceleration_m_per_s2, "
       "turn_rate_deg_per_s, retime, and"},
      {R"({"limits": {"retime": 1}})", "limits.retime: must be true or false"},
      {R"({"bounds": [1, 2, 3]})", "bounds: must be an object"},
      {R"({"bounds": {"low": [1, 2, 3]}})", "bounds.low: is unknown"},
      {R"({"bounds": {"min": [1, 2]}})", "bounds.min: must be an array of 3"},
      {R"({"bounds": {"min": [1, 2, 3, 4]}})", "bounds.min: must be an array of 3"},
      {R"({"bounds": {"max": [1, "2", 3]}})", "bounds.max[1]: must be a number"},
      {R"({"max_shrink": "much"})", "max_shrink: must be a number"},
      {R"({"repair_keyframes": 1})", "repair_keyframes: must be true or false"},
      {R"({"seed": 0})", "seed: is 0; it must be a whole number from 1"},
      {R"({"seed": -4})", "seed: is -4; it must be a whole number from 1"},
      {R"({"seed": 1.5})", "seed: is 1.5; it must be a whole number from 1"},
  };
  for (const auto& c : cases) {
    const auto parsed = options_of(c.options);
    EXPECT_FALSE(parsed) << c.options;
    EXPECT_THAT(parsed.error, StartsWith(std::string("R.json: ") + c.expected));
  }
}

/// Writes options as the members of a JSON object.
struct OptionText {
  std::string& text;

  template <class Member>
  void operator()(const FieldSpec& spec, const Member& member) const {
    const std::string value = value_of(spec, member);
    if (value.empty()) return;
    text += fmt::format("{}\"{}\": {}", text.empty() ? "" : ", ", spec.file_name(), value);
  }

 private:
  template <class Number>
  requires std::is_arithmetic_v<Number>
  static std::string value_of(const FieldSpec&, Number value) { return fmt::format("{}", value); }
  /// A limit that is not there is left out.
  static std::string value_of(const FieldSpec& spec, double value) {
    if (std::isinf(value)) return {};
    return fmt::format("{}", spec.is_angle() ? degrees(value) : value);
  }
  static std::string value_of(const FieldSpec& spec, const std::optional<double>& value) {
    return value ? value_of(spec, *value) : "";
  }
  template <base::NamedEnum Enum>
  static std::string value_of(const FieldSpec&, Enum value) {
    return fmt::format("\"{}\"", base::name_of(value));
  }
  static std::string value_of(const FieldSpec&, const geometry::Vec3& point) {
    return fmt::format("[{}, {}, {}]", point.x(), point.y(), point.z());
  }
  static std::string value_of(const FieldSpec&, const geometry::Bounds& bounds) {
    const auto side = [&](std::size_t i) {
      return std::isinf(bounds.limit_m(i)) ? "null" : fmt::format("{}", bounds.limit_m(i));
    };
    return fmt::format(R"({{"min": [{}, {}, {}], "max": [{}, {}, {}]}})", side(0), side(1), side(2),
                       side(3), side(4), side(5));
  }
  static std::string value_of(const FieldSpec&, const correction::MotionLimits& limits) {
    std::string members;
    planning::visit_table(OptionText{members}, limits);
    return "{" + members + "}";
  }
  static std::string value_of(const FieldSpec&, const correction::OrientationPolicy& policy) {
    std::string members;
    planning::visit_used(OptionText{members}, policy);
    return "{" + members + "}";
  }
};

TEST(JsonOptions, WhatIsWrittenIsReadBitForBit) {
  testing::Random random(testing::kSeed);
  for (int i = 0; i < 2000; ++i) {
    const PlanOptions options = testing::sample_options(random);
    std::string text;
    planning::visit_table(OptionText{text}, options);
    const auto parsed = options_of("{" + text + "}");
    ASSERT_TRUE(parsed) << parsed.error;
    ASSERT_EQ(*parsed, options) << "trial " << i << ": " << text;
  }
}

TEST(JsonOptions, TheSpeedOfDerivedTimesIsRead) {
  EXPECT_EQ(options_of(R"({"default_speed_m_per_s": 2.5})")->default_speed_m_per_s, 2.5);
  EXPECT_FALSE(options_of("{}")->default_speed_m_per_s);
}

}  // namespace
}  // namespace camway::tools
