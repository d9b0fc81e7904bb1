// SPDX-License-Identifier: MIT
#include "tools/make_scenes/office.h"

#include <string>

namespace camway::make_scenes {
namespace {

using namespace office;

constexpr Placement kWorld{};

std::string numbered(const std::string& name, int storey, const std::string& detail = "") {
  return name + '_' + std::to_string(storey) + (detail.empty() ? "" : '_' + detail);
}

/// Slab `level` is the floor of storey `level`; level 3 is the roof.
void add_floors(Scene& scene) {
  const Um inner = mm(200);
  const Opening stairs{kFlightAX0, kFlightBX1, kLandingZ0, kFlightFootZ};
  const Opening shaft{kShaftX0, kShaftX1 - inner, kShaftZ0, kShaftZ1 - inner};
  const Opening atrium{kVoidX0, kVoidX1, kVoidZ0, kVoidZ1};
  for (int level = 0; level <= kStoreys; ++level) {
    scene.begin_object(level < kStoreys ? numbered("floor", level) : "roof");
    const Slab slab{0, kEastX, 0, kSouthZ, floor_y(level) - kSlabThickness, floor_y(level)};
    const bool pierced = level == 1 || level == 2;
    add_slab(scene, slab,
             pierced ? std::vector<Opening>{stairs, shaft, atrium} : std::vector<Opening>{});
  }
}

/// Two windows for each room, 1.6 x 1.4 m, 0.9 m above the floor.
std::vector<Opening> windows(Um floor, bool north) {
  std::vector<Opening> result;
  for (const Room& room : kRooms) {
    if (room.north != north) continue;
    for (const Um x : {room.x0 + mm(1500), room.x1 - mm(1500)}) {
      if (x > kShaftX0 && x < kShaftX1 + mm(800) && north) continue;
      result.push_back({x - mm(800), x + mm(800), floor + mm(900), floor + mm(2300)});
    }
  }
  return result;
}

void add_mullions(Scene& scene, const std::vector<Opening>& openings, Um z) {
  for (const Opening& o : openings) {
    const Um x = (o.u0 + o.u1) / 2;
    const Um y = (o.v0 + o.v1) / 2;
    scene.add_box(kWorld, {x - mm(25), o.v0, z - mm(25)}, {x + mm(25), o.v1, z + mm(25)});
    scene.add_box(kWorld, {o.u0, y - mm(20), z - mm(20)}, {o.u1, y + mm(20), z + mm(20)});
  }
}

void add_outer_walls(Scene& scene, int storey) {
  const Um y0 = floor_y(storey);
  const Um y1 = floor_y(storey + 1) - kSlabThickness;
  const std::vector<Opening> north = windows(y0, true);
  std::vector<Opening> south = windows(y0, false);
  const Um atrium_x = (kAtriumX0 + kAtriumX1) / 2;
  south.push_back({atrium_x - mm(1500), atrium_x + mm(1500), y0 + mm(300), y0 + mm(2800)});
  const Opening corridor_end{kCorridorMiddleZ - mm(700), kCorridorMiddleZ + mm(700), y0 + mm(900),
                             y0 + mm(2300)};

  scene.begin_object(numbered("wall_outer", storey, "north"));
  add_wall(scene, WallAlongX{0, kEastX, y0, y1, 0, kOuterWall}, north);
  scene.begin_object(numbered("wall_outer", storey, "south"));
  add_wall(scene, WallAlongX{0, kEastX, y0, y1, kSouthZ - kOuterWall, kSouthZ}, south);
  scene.begin_object(numbered("wall_outer", storey, "west"));
  add_wall(scene, WallAlongZ{kOuterWall, kSouthZ - kOuterWall, y0, y1, 0, kOuterWall},
           {corridor_end});
  scene.begin_object(numbered("wall_outer", storey, "east"));
  add_wall(scene, WallAlongZ{kOuterWall, kSouthZ - kOuterWall, y0, y1, kEastX - kOuterWall, kEastX},
           {corridor_end});
  scene.begin_object(numbered("windows", storey));
  add_mullions(scene, north, kOuterWall / 2);
  add_mullions(scene, south, kSouthZ - kOuterWall / 2);
}

void add_corridor_walls(Scene& scene, int storey) {
  const Um y0 = floor_y(storey);
  const Um y1 = floor_y(storey + 1) - kSlabThickness;
  std::vector<Opening> north;
  std::vector<Opening> south;
  for (const Room& room : kRooms) {
    (room.north ? north : south)
        .push_back(
            {room.door_x - kDoorWidth / 2, room.door_x + kDoorWidth / 2, y0, y0 + kDoorHeight});
  }
  north.push_back({mm(13300), mm(16700), y0, y0 + mm(2500)});  // to the stairs
  south.push_back({mm(13000), mm(17000), y0, y0 + mm(2700)});  // to the atrium
  const Um west = kOuterWall;
  const Um east = kEastX - kOuterWall;
  scene.begin_object(numbered("wall_corridor", storey, "north"));
  add_wall(scene, WallAlongX{west, east, y0, y1, kCorridorNorthZ - kInnerWall, kCorridorNorthZ},
           north);
  scene.begin_object(numbered("wall_corridor", storey, "south"));
  add_wall(scene, WallAlongX{west, east, y0, y1, kCorridorSouthZ, kCorridorSouthZ + kInnerWall},
           south);
}

/// The walls between rooms run from the corridor's wall to the outer wall.
void add_partitions(Scene& scene, int storey) {
  const Um y0 = floor_y(storey);
  const Um y1 = floor_y(storey + 1) - kSlabThickness;
  for (std::size_t i = 0; i < kRooms.size(); ++i) {
    const Room& room = kRooms[i];
    const Um z0 = room.north ? kOuterWall : kCorridorSouthZ + kInnerWall;
    const Um z1 = room.north ? kCorridorNorthZ - kInnerWall : kSouthZ - kOuterWall;
    std::vector<Opening> doors;
    if (has_inner_door(storey, i)) {
      const Um z = room.z_at(kInnerDoorDepth);
      doors.push_back({z - kDoorWidth / 2, z + kDoorWidth / 2, y0, y0 + kDoorHeight});
    }
    if (i % 4 != 3) {
      scene.begin_object(numbered("wall", storey, std::string(room.name) + "_east"));
      add_wall(scene, WallAlongZ{z0, z1, y0, y1, room.x1, room.x1 + kInnerWall}, doors);
    }
    if (i % 4 == 2) {  // the far side of the stairs and of the atrium
      scene.begin_object(numbered("wall", storey, std::string(room.name) + "_west"));
      add_wall(scene, WallAlongZ{z0, z1, y0, y1, room.x0 - kInnerWall, room.x0});
    }
  }
}

void add_shaft(Scene& scene, int storey) {
  const Um y0 = floor_y(storey);
  const Um y1 = floor_y(storey + 1) - kSlabThickness;
  const Um thick = mm(200);
  scene.begin_object(numbered("shaft", storey));
  add_wall(scene, WallAlongX{kShaftX0, kShaftX1, y0, y1, kShaftZ1 - thick, kShaftZ1});
  add_wall(scene, WallAlongZ{kShaftZ0, kShaftZ1 - thick, y0, y1, kShaftX1 - thick, kShaftX1});
}

/// Twenty steps of 18 cm: ten up to the landing, ten back.
void add_stairs(Scene& scene, int storey) {
  constexpr int kSteps = 10;
  const Um y = floor_y(storey);
  const Um rise = kStoreyHeight / (2 * kSteps);
  const Um tread = (kFlightFootZ - kLandingZ1) / kSteps;
  const Um waist = mm(120);
  scene.begin_object(numbered("stairs", storey));
  for (int step = 0; step < kSteps; ++step) {
    const Um top_a = y + rise * (step + 1);
    const Um z1_a = kFlightFootZ - tread * step;
    scene.add_box(kWorld, {kFlightAX0, step == 0 ? y : top_a - rise - waist, z1_a - tread},
                  {kFlightAX1, top_a, z1_a});
    const Um top_b = y + kStoreyHeight / 2 + rise * (step + 1);
    const Um z0_b = kLandingZ1 + tread * step;
    scene.add_box(kWorld, {kFlightBX0, top_b - rise - waist, z0_b},
                  {kFlightBX1, top_b, z0_b + tread});
  }
  const Um landing = y + kStoreyHeight / 2;
  scene.add_box(kWorld, {kStairsX0, landing - mm(200), kLandingZ0},
                {kStairsX1, landing, kLandingZ1});
}

/// Posts and two rails along one side of an opening in the floor.
void add_railing(Scene& scene, Um y, Point from, Point to) {
  const std::size_t along = from[0] != to[0] ? 0 : 2;
  const Um half = mm(20);
  const Um length = to[along] - from[along];
  const Um posts = length / mm(600) + 1;
  for (Um i = 0; i <= posts; ++i) {
    Point foot = from;
    foot[along] += length * i / posts;
    scene.add_box(kWorld, {foot[0] - half, y, foot[2] - half},
                  {foot[0] + half, y + mm(1000), foot[2] + half});
  }
  for (const Um height : {mm(500), mm(1000)}) {
    scene.add_box(kWorld, {from[0] - half, y + height - half, from[2] - half},
                  {to[0] + half, y + height + half, to[2] + half});
  }
}

void add_railings(Scene& scene, int storey) {
  const Um y = floor_y(storey);
  const Um inset = mm(100);
  const Um x0 = kVoidX0 - inset;
  const Um x1 = kVoidX1 + inset;
  const Um z0 = kVoidZ0 - inset;
  const Um z1 = kVoidZ1 + inset;
  scene.begin_object(numbered("railing", storey, "atrium"));
  add_railing(scene, y, {x0, 0, z0}, {x1, 0, z0});
  add_railing(scene, y, {x0, 0, z1}, {x1, 0, z1});
  add_railing(scene, y, {x0, 0, z0}, {x0, 0, z1});
  add_railing(scene, y, {x1, 0, z0}, {x1, 0, z1});
}

void add_columns(Scene& scene) {
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    scene.begin_object("column_" + std::to_string(i));
    scene.add_prism(kWorld, {kColumns[i][0], 0, kColumns[i][1]}, kColumnRadius,
                    floor_y(kStoreys) - kSlabThickness, 24);
  }
}

}  // namespace

Scene make_office() {
  Scene scene;
  Dice dice(5);
  add_floors(scene);
  for (int storey = 0; storey < kStoreys; ++storey) {
    add_outer_walls(scene, storey);
    add_corridor_walls(scene, storey);
    add_partitions(scene, storey);
    add_shaft(scene, storey);
    if (storey + 1 < kStoreys) add_stairs(scene, storey);
    if (storey > 0) add_railings(scene, storey);
    for (std::size_t room = 0; room < kRooms.size(); ++room)
      furnish_room(scene, storey, room, dice);
  }
  add_columns(scene);
  furnish_atrium(scene, dice);
  return scene;
}

}  // namespace camway::make_scenes
