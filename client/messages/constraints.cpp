// SPDX-License-Identifier: MIT
#include "client/messages/constraints.h"

#include <algorithm>

#include <camway/plan_request_t.hpp>

namespace camway {
namespace {

std::int8_t to_wire(Orientation::Policy policy) {
  switch (policy) {
    case Orientation::Policy::kFree:
      return orientation_t::FREE;
    case Orientation::Policy::kKeep:
      return orientation_t::KEEP;
    case Orientation::Policy::kLevel:
      return orientation_t::LEVEL;
    case Orientation::Policy::kTarget:
      return orientation_t::TARGET;
  }
  return orientation_t::FREE;
}

}  // namespace

std::int8_t to_wire(Objective objective) {
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

orientation_t to_wire(const Orientation& orientation) {
  orientation_t wire{};
  wire.policy = to_wire(orientation.policy);
  std::copy(orientation.up.begin(), orientation.up.end(), wire.up);
  std::copy(orientation.target_m.begin(), orientation.target_m.end(), wire.target_m);
  wire.cone_rad = orientation.cone_rad;
  wire.has_max_turn = orientation.max_turn_rad ? 1 : 0;
  wire.max_turn_rad = orientation.max_turn_rad.value_or(0.0);
  return wire;
}

motion_limits_t to_wire(const MotionLimits& limits) {
  motion_limits_t wire{};
  wire.speed_m_per_s = limits.speed_m_per_s;
  wire.acceleration_m_per_s2 = limits.acceleration_m_per_s2;
  wire.turn_rate_rad_per_s = limits.turn_rate_rad_per_s;
  wire.may_retime = limits.may_retime ? 1 : 0;
  return wire;
}

bounds_t to_wire(const Bounds& bounds) {
  bounds_t wire{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    wire.has_min[axis] = bounds.min_m[axis] ? 1 : 0;
    wire.min_m[axis] = bounds.min_m[axis].value_or(0.0);
    wire.has_max[axis] = bounds.max_m[axis] ? 1 : 0;
    wire.max_m[axis] = bounds.max_m[axis].value_or(0.0);
  }
  return wire;
}

Bounds from_wire(const bounds_t& wire) {
  Bounds bounds;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (wire.has_min[axis] != 0) bounds.min_m[axis] = wire.min_m[axis];
    if (wire.has_max[axis] != 0) bounds.max_m[axis] = wire.max_m[axis];
  }
  return bounds;
}

}  // namespace camway
