// SPDX-License-Identifier: MIT
#pragma once

#include "tools/make_scenes/solid.h"

namespace camway::make_scenes {

/// The plan of the gallery: a corridor of 40 x 4 m, 3 m high, along x. Each exhibit stands at its
/// own x; the strip z > 3 m is free up to the slot.
namespace gallery {

constexpr Um kLength = mm(40000);
constexpr Um kWidth = mm(4000);
constexpr Um kHeight = mm(3000);
constexpr Um kEyeY = mm(1600);
constexpr Um kMiddleZ = mm(2000);

constexpr Um kCubeX = mm(3000);        ///< a cube of 5 cm in mid air, at eye height
constexpr Um kPolesX = mm(7000);       ///< poles of 1 cm from floor to ceiling
constexpr Um kWiresX = mm(11000);      ///< wires of 1 mm from wall to wall
constexpr Um kTrianglesX = mm(15000);  ///< single triangles that hang freely
constexpr Um kPlatesX = mm(19000);     ///< plates without thickness
constexpr Um kLouvreX = mm(23000);     ///< slats across half the corridor
constexpr Um kRingX = mm(27000);       ///< a ring of 0.6 m radius, its axis along x
constexpr Um kFanX = mm(31000);        ///< 240 triangles at one vertex, slivers, duplicates
constexpr Um kSlotX = mm(36000);  ///< a wall with a slot of 0.3 x 2 m, and a rod in front of it

constexpr Um kRingRadius = mm(600);
constexpr Um kSlotZ = mm(1200);
constexpr Um kRodZ = mm(2800);

}  // namespace gallery

/// Returns a corridor with exhibits of thin, single, duplicated and degenerate geometry. The
/// exhibits are added in order of x.
Scene make_gallery();

}  // namespace camway::make_scenes
