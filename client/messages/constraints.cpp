// SPDX-License-Identifier: MIT
#include "client/messages/constraints.h"

#include <camway/plan_request_t.hpp>

#include "client/messages/members.h"

namespace camway {

static_assert(static_cast<int>(Objective::kSafest) == plan_request_t::SAFEST);
static_assert(static_cast<int>(Orientation::Policy::kTarget) == orientation_t::TARGET);

void put(const Bounds& mine, bounds_t& wire) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    wire.has_min[axis] = mine.min_m[axis] ? 1 : 0;
    wire.has_max[axis] = mine.max_m[axis] ? 1 : 0;
    put(mine.min_m[axis], wire.min_m[axis]);
    put(mine.max_m[axis], wire.max_m[axis]);
  }
}

void read(const bounds_t& wire, Bounds& mine) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (wire.has_min[axis] != 0) mine.min_m[axis] = wire.min_m[axis];
    if (wire.has_max[axis] != 0) mine.max_m[axis] = wire.max_m[axis];
  }
}

void put(const Orientation& mine, orientation_t& wire) {
  static_assert(wire::lacks_only<orientation_t, Orientation>({"has_max_turn"}));
  put_common(mine, wire);
  wire.has_max_turn = mine.max_turn_rad ? 1 : 0;
}

}  // namespace camway
