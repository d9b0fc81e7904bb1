// SPDX-License-Identifier: MIT
#pragma once

#include <camway/constraints.h>

#include <cstdint>

#include <camway/bounds_t.hpp>
#include <camway/motion_limits_t.hpp>
#include <camway/orientation_t.hpp>

namespace camway {

std::int8_t to_wire(Objective objective);
orientation_t to_wire(const Orientation& orientation);
motion_limits_t to_wire(const MotionLimits& limits);
bounds_t to_wire(const Bounds& bounds);
Bounds from_wire(const bounds_t& wire);

}  // namespace camway
