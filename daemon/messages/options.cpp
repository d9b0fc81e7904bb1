// SPDX-License-Identifier: MIT
#include "daemon/messages/options.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "daemon/messages/bounds.h"

namespace camway::service {
namespace {

using correction::MotionLimits;
using correction::Objective;
using correction::OrientationPolicy;
using correction::OrientationRule;
using geometry::Vec3;

std::int8_t wire_objective(Objective objective) {
  switch (objective) {
    case Objective::kClosest:
      return plan_request_t::CLOSEST;
    case Objective::kShortest:
      return plan_request_t::SHORTEST;
    case Objective::kSmoothest:
      return plan_request_t::SMOOTHEST;
    case Objective::kSafest:
      return plan_request_t::SAFEST;
  }
  return plan_request_t::CLOSEST;
}

std::optional<Objective> objective_of(std::int8_t wire) {
  for (const Objective objective :
       {Objective::kClosest, Objective::kShortest, Objective::kSmoothest, Objective::kSafest}) {
    if (wire_objective(objective) == wire) return objective;
  }
  return std::nullopt;
}

std::int8_t wire_rule(OrientationRule rule) {
  switch (rule) {
    case OrientationRule::kFree:
      return orientation_t::FREE;
    case OrientationRule::kKeep:
      return orientation_t::KEEP;
    case OrientationRule::kLevel:
      return orientation_t::LEVEL;
    case OrientationRule::kTarget:
      return orientation_t::TARGET;
  }
  return orientation_t::FREE;
}

std::optional<OrientationRule> rule_of(std::int8_t wire) {
  for (const OrientationRule rule : {OrientationRule::kFree, OrientationRule::kKeep,
                                     OrientationRule::kLevel, OrientationRule::kTarget}) {
    if (wire_rule(rule) == wire) return rule;
  }
  return std::nullopt;
}

Vec3 vec3(const double (&from)[3]) { return {from[0], from[1], from[2]}; }

/// Only an exact 0 asks for the default: NaN and negative values go on to `planning::validate`.
double or_default(double wire, double fallback) { return wire == 0.0 ? fallback : wire; }

/// Copies the values: infinity means no limit on the wire, too.
motion_limits_t wire_limits(const MotionLimits& limits) {
  motion_limits_t wire{};
  wire.speed_m_per_s = limits.speed_m_per_s;
  wire.acceleration_m_per_s2 = limits.acceleration_m_per_s2;
  wire.turn_rate_rad_per_s = limits.turn_rate_rad_per_s;
  wire.may_retime = limits.may_retime ? 1 : 0;
  return wire;
}

MotionLimits limits_of(const motion_limits_t& wire) {
  const MotionLimits defaults;
  MotionLimits limits;
  limits.speed_m_per_s = or_default(wire.speed_m_per_s, defaults.speed_m_per_s);
  limits.acceleration_m_per_s2 =
      or_default(wire.acceleration_m_per_s2, defaults.acceleration_m_per_s2);
  limits.turn_rate_rad_per_s = or_default(wire.turn_rate_rad_per_s, defaults.turn_rate_rad_per_s);
  limits.may_retime = wire.may_retime != 0;
  return limits;
}

orientation_t wire_orientation(const OrientationPolicy& policy) {
  orientation_t wire{};
  wire.policy = wire_rule(policy.rule);
  if (policy.rule == OrientationRule::kLevel) std::copy_n(policy.up_W.data(), 3, wire.up);
  if (policy.rule == OrientationRule::kTarget) {
    std::copy_n(policy.target_W.data(), 3, wire.target_m);
    wire.cone_rad = policy.cone_rad;
  }
  wire.has_max_turn = 1;
  wire.max_turn_rad = policy.max_turn_rad;
  return wire;
}

/// Returns an error about a member that has a value but no effect with this rule: its sender meant
/// it.
std::string idle_member(const orientation_t& wire, OrientationRule rule) {
  const Vec3 zero = Vec3::Zero();
  if (rule != OrientationRule::kLevel && vec3(wire.up) != zero) {
    return "orientation.up: counts only with the policy LEVEL; leave it zero";
  }
  if (rule != OrientationRule::kTarget && vec3(wire.target_m) != zero) {
    return "orientation.target_m: counts only with the policy TARGET; leave it zero";
  }
  if (rule != OrientationRule::kTarget && wire.cone_rad != 0.0) {
    return "orientation.cone_rad: counts only with the policy TARGET; leave it 0";
  }
  if (wire.has_max_turn == 0 && wire.max_turn_rad != 0.0) {
    return "orientation.max_turn_rad: counts only with has_max_turn; set that, or leave it 0";
  }
  return {};
}

OrientationPolicy orientation_of(const orientation_t& wire, OrientationRule rule) {
  OrientationPolicy policy;
  policy.rule = rule;
  const Vec3 up_W = vec3(wire.up);
  if (up_W != Vec3::Zero()) policy.up_W = planning::direction_of(up_W);
  policy.target_W = vec3(wire.target_m);
  policy.cone_rad = or_default(wire.cone_rad, policy.cone_rad);
  if (wire.has_max_turn != 0) policy.max_turn_rad = wire.max_turn_rad;
  return policy;
}

}  // namespace

void put_correction_options(const planning::PlanOptions& options, plan_request_t& wire) {
  wire.objective = wire_objective(options.objective);
  wire.orientation = wire_orientation(options.orientation);
  wire.limits = wire_limits(options.limits);
  wire.bounds = wire_bounds(options.bounds);
  wire.max_shrink = options.max_shrink;
  wire.repair_keyframes = options.repair_keyframes ? 1 : 0;
  wire.seed = static_cast<std::int64_t>(options.seed);
}

std::string read_correction_options(const plan_request_t& wire, planning::PlanOptions& options) {
  const std::optional<Objective> objective = objective_of(wire.objective);
  if (!objective) return "objective: " + std::to_string(wire.objective) + " is unknown";
  const std::optional<OrientationRule> rule = rule_of(wire.orientation.policy);
  if (!rule) {
    return "orientation.policy: " + std::to_string(wire.orientation.policy) + " is unknown";
  }
  if (std::string error = idle_member(wire.orientation, *rule); !error.empty()) return error;
  options.objective = *objective;
  options.orientation = orientation_of(wire.orientation, *rule);
  options.limits = limits_of(wire.limits);
  options.bounds = bounds_of(wire.bounds);
  options.max_shrink = wire.max_shrink;
  options.repair_keyframes = wire.repair_keyframes != 0;
  if (wire.seed != 0) options.seed = static_cast<std::uint64_t>(wire.seed);
  return {};
}

}  // namespace camway::service
