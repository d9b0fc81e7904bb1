// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "daemon/motion/body/body.h"
#include "daemon/planning/request/request.h"
#include "daemon/scene/mesh/mesh.h"

/// Bodies that have to pass holes little larger than they are.
namespace camway::bench {

/// The bodies that move. Each but the ring goes through a hole in a wall that fits its profile,
/// from one room to another; the ring is lifted off a pole. The robot stands just above the floor
/// before a door, as it fits through it, but not straight before it.
inline constexpr std::array<std::string_view, 6> kNarrowBodies = {"box",   "L",    "table",
                                                                  "piano", "ring", "robot"};

struct NarrowCase {
  scene::Mesh scene;
  planning::PlanRequest request;
};

/// Returns a case. `body`: index in `kNarrowBodies`. `spare`: by how much the hole is wider and
/// higher than the profile of the body, as a share of it. `seed` chooses places, orientations, the
/// thickness of the wall, and whether the hole reaches the floor.
NarrowCase narrow_case(std::size_t body, double spare, std::uint32_t seed);

}  // namespace camway::bench
