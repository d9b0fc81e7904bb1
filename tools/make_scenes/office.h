// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "tools/make_scenes/solid.h"

namespace camway::make_scenes {

/// The plan of the office building: three storeys of 30 x 20 m, x to the east and z to the south. A
/// corridor runs from west to east in the middle of each storey; rooms n0..n3 lie north of it, with
/// the stairs between n1 and n2; rooms s0..s3 lie south, with the atrium between s1 and s2.
namespace office {

constexpr int kStoreys = 3;
constexpr Um kStoreyHeight = mm(3600);
constexpr Um kSlabThickness = mm(300);
constexpr Um kEastX = mm(30000);
constexpr Um kSouthZ = mm(20000);
constexpr Um kOuterWall = mm(300);
constexpr Um kCorridorNorthZ = mm(8600);  ///< faces of the corridor's walls
constexpr Um kCorridorSouthZ = mm(11400);
constexpr Um kCorridorMiddleZ = mm(10000);
constexpr Um kInnerWall = mm(200);
constexpr Um kDoorHeight = mm(2100);

/// Returns the height of the floor of a storey.
constexpr Um floor_y(int storey) { return storey * kStoreyHeight; }

struct Room {
  const char* name;
  bool north;
  Um x0, x1;  ///< inner faces of its walls
  Um door_x;  ///< centre of its door to the corridor

  [[nodiscard]] constexpr Um middle_x() const { return (x0 + x1) / 2; }
  /// Returns the z at `depth` into the room, measured from the room's face of the corridor wall.
  [[nodiscard]] constexpr Um z_at(Um depth) const {
    return north ? kCorridorNorthZ - kInnerWall - depth : kCorridorSouthZ + kInnerWall + depth;
  }
};

constexpr Um kDoorWidth = mm(950);

constexpr std::array<Room, 8> kRooms{{
    {"n0", true, mm(300), mm(6400), mm(3350)},
    {"n1", true, mm(6600), mm(12900), mm(9750)},
    {"n2", true, mm(17100), mm(23000), mm(20050)},
    {"n3", true, mm(23200), mm(29700), mm(26450)},
    {"s0", false, mm(300), mm(5900), mm(3100)},
    {"s1", false, mm(6100), mm(11900), mm(9000)},
    {"s2", false, mm(18100), mm(23900), mm(21000)},
    {"s3", false, mm(24100), mm(29700), mm(26900)},
}};

/// Depth from the corridor at which the doors between adjacent rooms are.
constexpr Um kInnerDoorDepth = mm(1300);
/// Returns whether the partition between room `index` and the next has a door on `storey`.
constexpr bool has_inner_door(int storey, std::size_t index) {
  return (index == 0 && storey != 1) || (index == 6 && storey >= 1);
}

// The stairs: flight A at x0..x1 climbs northwards, flight B back southwards.
constexpr Um kStairsX0 = mm(13100);
constexpr Um kStairsX1 = mm(16900);
constexpr Um kFlightAX0 = mm(13200);
constexpr Um kFlightAX1 = mm(14800);
constexpr Um kFlightBX0 = mm(15200);
constexpr Um kFlightBX1 = mm(16800);
constexpr Um kFlightFootZ = mm(6000);
constexpr Um kLandingZ1 = mm(3200);
constexpr Um kLandingZ0 = mm(600);

// The atrium, open from the ground floor to the roof, with a gallery around the opening.
constexpr Um kAtriumX0 = mm(12100);
constexpr Um kAtriumX1 = mm(17900);
constexpr Um kVoidX0 = mm(12900);
constexpr Um kVoidX1 = mm(17100);
constexpr Um kVoidZ0 = mm(12800);
constexpr Um kVoidZ1 = mm(18900);
constexpr Um kColumnRadius = mm(220);
constexpr std::array<std::array<Um, 2>, 6> kColumns{{{mm(13400), mm(13300)},
                                                     {mm(16600), mm(13300)},
                                                     {mm(13400), mm(15850)},
                                                     {mm(16600), mm(15850)},
                                                     {mm(13400), mm(18400)},
                                                     {mm(16600), mm(18400)}}};

// A lift shaft without doors, in room n2's corner by the stairs: closed on all sides.
constexpr Um kShaftX0 = mm(17100);
constexpr Um kShaftX1 = mm(19000);
constexpr Um kShaftZ0 = mm(300);
constexpr Um kShaftZ1 = mm(2400);

// A safe in room s3 of the ground floor.
constexpr Um kSafeX = mm(28700);
constexpr Um kSafeZ = mm(13200);

}  // namespace office

/// Returns the building with its furniture.
Scene make_office();

/// Furnish a room of `storey`, and the atrium.
void furnish_room(Scene& scene, int storey, std::size_t room_index, Dice& dice);
void furnish_atrium(Scene& scene, Dice& dice);

}  // namespace camway::make_scenes
