// SPDX-License-Identifier: MIT
#pragma once

#include <camway/constraints.h>

#include <camway/bounds_t.hpp>
#include <camway/orientation_t.hpp>

namespace camway {

/// A side without a limit has `has_min` or `has_max` 0 in the message.
void put(const Bounds& mine, bounds_t& wire);
void read(const bounds_t& wire, Bounds& mine);

void put(const Orientation& mine, orientation_t& wire);

}  // namespace camway
