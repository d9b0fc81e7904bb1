// SPDX-License-Identifier: MIT
#include "tools/json/json_options.h"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "tools/json/json_angle.h"

namespace camway::tools {
namespace {

using correction::MotionLimits;
using correction::OrientationPolicy;
using correction::OrientationRule;
using planning::PlanOptions;

constexpr std::array<std::pair<std::string_view, OrientationRule>, 4> kPolicies{{
    {"free", OrientationRule::kFree},
    {"keep", OrientationRule::kKeep},
    {"level", OrientationRule::kLevel},
    {"target", OrientationRule::kTarget},
}};

planning::Method read_method(const Field& field) {
  const std::string name = field.text();
  const std::optional<planning::Method> method = planning::method_from_string(name);
  if (!method) field.fail("'" + name + "' is unknown; there are ladder, keyframe_insertion");
  return method.value_or(planning::Method::kLadder);
}

geometry::Vec3 read_point(const Field& field) {
  geometry::Vec3 point;
  field.numbers(point.data(), 3);
  return point;
}

void read_number(const Field& parent, std::string_view key, double& value) {
  if (const auto member = parent.optional_member(key)) value = member->number();
}

void read_angle(const Field& parent, std::string_view key, double& value_rad) {
  if (const auto member = parent.optional_member(key)) value_rad = radians(member->number());
}

/// Records an error if `key` is there although the policy does not use it.
void refuse_without(std::string_view policy, const Field& field, std::string_view key) {
  if (const auto member = field.optional_member(key)) {
    member->fail("counts only with \"policy\": \"" + std::string(policy) + "\"");
  }
}

OrientationPolicy read_orientation(const Field& field) {
  field.allow_only({"policy", "up", "target", "cone_deg", "max_turn_deg"});
  OrientationPolicy policy;
  if (const auto name = field.optional_member("policy")) policy.rule = named(*name, kPolicies);
  read_angle(field, "max_turn_deg", policy.max_turn_rad);
  if (policy.rule != OrientationRule::kLevel) {
    refuse_without("level", field, "up");
  } else if (const auto up = field.optional_member("up")) {
    policy.up_W = planning::direction_of(read_point(*up));
  }
  if (policy.rule == OrientationRule::kTarget) {
    policy.target_W = read_point(field.member("target"));
    read_angle(field, "cone_deg", policy.cone_rad);
  } else {
    refuse_without("target", field, "target");
    refuse_without("target", field, "cone_deg");
  }
  return policy;
}

void read_corner(const Field& parent, std::string_view key, geometry::Vec3& corner_W) {
  const auto list = parent.optional_member(key);
  if (!list) return;
  if (list->size() != 3) list->fail("must be an array of 3, each a number or null");
  for (std::size_t axis = 0; axis < 3 && !list->failed(); ++axis) {
    const Field item = list->element(axis);
    if (!item.is_null()) corner_W[static_cast<Eigen::Index>(axis)] = item.number();
  }
}

MotionLimits read_limits(const Field& field) {
  field.allow_only({"speed", "acceleration", "turn_rate_deg", "retime"});
  MotionLimits limits;
  read_number(field, "speed", limits.speed_m_per_s);
  read_number(field, "acceleration", limits.acceleration_m_per_s2);
  read_angle(field, "turn_rate_deg", limits.turn_rate_rad_per_s);
  if (const auto retime = field.optional_member("retime")) limits.may_retime = retime->boolean();
  return limits;
}

}  // namespace

geometry::Bounds read_bounds(const Field& field) {
  field.allow_only({"min", "max"});
  geometry::Bounds bounds;
  read_corner(field, "min", bounds.min_W);
  read_corner(field, "max", bounds.max_W);
  return bounds;
}

PlanOptions read_options(const Field& field) {
  field.allow_only({"method", "deadline_s", "clearance", "chord_error_m", "interval_tolerance_m",
                    "max_inserted_keyframes", "objective", "orientation", "limits", "bounds",
                    "max_shrink", "repair_keyframes", "seed", "default_speed_m_per_s"});
  PlanOptions options;
  if (const auto option = field.optional_member("method")) options.method = read_method(*option);
  read_number(field, "deadline_s", options.deadline_s);
  read_number(field, "clearance", options.clearance_m);
  read_number(field, "chord_error_m", options.chord_error_m);
  read_number(field, "interval_tolerance_m", options.interval_tolerance_m);
  if (const auto option = field.optional_member("max_inserted_keyframes")) {
    options.max_inserted_keyframes =
        static_cast<std::int32_t>(option->integer(0, std::numeric_limits<std::int32_t>::max()));
  }
  if (const auto option = field.optional_member("objective")) {
    options.objective = named(*option, kObjectives);
  }
  if (const auto option = field.optional_member("orientation")) {
    options.orientation = read_orientation(*option);
  }
  if (const auto option = field.optional_member("limits")) options.limits = read_limits(*option);
  if (const auto option = field.optional_member("bounds")) options.bounds = read_bounds(*option);
  read_number(field, "max_shrink", options.max_shrink);
  if (const auto option = field.optional_member("repair_keyframes")) {
    options.repair_keyframes = option->boolean();
  }
  if (const auto option = field.optional_member("seed")) {
    options.seed =
        static_cast<std::uint64_t>(option->integer(1, std::numeric_limits<std::int64_t>::max()));
  }
  if (const auto option = field.optional_member("default_speed_m_per_s")) {
    options.default_speed_m_per_s = option->number();
  }
  return options;
}

}  // namespace camway::tools
