// SPDX-License-Identifier: MIT
#include "tools/make_scenes/catalogue.h"
#include "tools/make_scenes/office.h"

namespace camway::make_scenes {
namespace {

using namespace office;

constexpr Direction kEast{1, 0, 0};
constexpr Direction kNorth{0, 0, -1};
constexpr Direction kSouth{0, 0, 1};
constexpr Direction kWest{-1, 0, 0};

/// Returns a point from millimetres, `above_floor` above the floor of a storey.
Point at(int storey, std::int64_t x, std::int64_t above_floor, std::int64_t z) {
  return {mm(x), floor_y(storey) + mm(above_floor), mm(z)};
}

Request way_up_the_stairs() {
  std::vector<Point> stairs{
      at(0, 14000, 1600, 7800), at(0, 14000, 1700, 6300), at(0, 14000, 2500, 4600),
      at(0, 14000, 3350, 2700), at(0, 14500, 3450, 1800), at(0, 15500, 3450, 1800),
      at(0, 16000, 3500, 2700), at(0, 16000, 4350, 4600), at(1, 16000, 1600, 6400),
      at(1, 16000, 1600, 7800), at(1, 15400, 1600, 9400)};
  return {"office-free-stairs",
          "up the stairs from the ground floor to the first",
          {70, 55, mm(100)},
          along(stairs),
          {}};
}

Request spiral_in_the_atrium() {
  std::vector<Point> spiral;
  for (int k = 0; k < 12; ++k) {
    const Point ring = on_circle(mm(1000), 2 * k);
    spiral.push_back({mm(15000) + ring[0], mm(1500) + mm(420) * k, mm(15850) + ring[2]});
  }
  return {"office-free-atrium",
          "a full turn upwards in the atrium, twelve keyframes",
          {80, 60, mm(150)},
          along(spiral),
          {}};
}

Request turn_on_the_spot() {
  const Point centre = at(2, 21000, 1500, 12900);
  return {"office-free-turn",
          "turns on the spot in steps of a quarter turn",
          {80, 60, mm(300)},
          {{centre, look_along(kNorth)},
           {centre, look_along(kEast)},
           {centre, look_along(kSouth)},
           {centre, look_along(kWest)}},
          {}};
}

std::vector<Request> free_requests() {
  std::vector<Request> r;
  r.push_back({"office-free-corridor",
               "along the ground floor's corridor",
               {80, 60, mm(200)},
               along({at(0, 1500, 1600, 10000), at(0, 9000, 1600, 10250), at(0, 20000, 1600, 9750),
                      at(0, 28500, 1600, 10000)}),
               {}});
  r.push_back({"office-free-straight",
               "two keyframes: the path is a line",
               {90, 60, mm(400)},
               along({at(2, 2000, 1500, 10000), at(2, 28000, 1700, 10000)}),
               {}});
  r.push_back({"office-free-door",
               "through the middle of a door into room n1",
               {75, 55, mm(150)},
               along({at(0, 9750, 1500, 10600), at(0, 9750, 1500, 8500), at(0, 9750, 1500, 6200)}),
               {}});
  r.push_back(
      {"office-free-two-rooms",
       "from the corridor through s2 and its inner door into s3",
       {70, 50, mm(80)},
       along({at(1, 21000, 1500, 10300), at(1, 21000, 1500, 11500), at(1, 21900, 1500, 12700),
              at(1, 24000, 1500, 12900), at(1, 26000, 1500, 13500)}),
       {}});
  r.push_back(way_up_the_stairs());
  r.push_back(spiral_in_the_atrium());
  r.push_back({"office-free-timed",
               "uneven times, looking sideways",
               {85, 60, mm(250)},
               facing({at(1, 3000, 1600, 10000), at(1, 8000, 1600, 9800), at(1, 11000, 1600, 10100),
                       at(1, 24000, 1600, 10000)},
                      {1, 0, -0.75}),
               {0, 2500, 3800, 11000}});
  r.push_back(turn_on_the_spot());
  return r;
}

std::vector<Request> graze_requests() {
  std::vector<Request> r;
  r.push_back({"office-graze-door",
               "clips a door's jamb on the way into room n1",
               {80, 60, mm(150)},
               along({at(0, 8800, 1500, 10300), at(0, 9900, 1500, 6900)}),
               {}});
  r.push_back({"office-graze-chair",
               "low over the back of a chair",
               {80, 60, mm(150)},
               along({at(0, 11750, 1000, 6900), at(0, 11750, 1000, 3500)}),
               {}});
  r.push_back(
      {"office-graze-column",
       "brushes a column of the atrium",
       {80, 60, mm(150)},
       along({at(0, 12500, 1600, 12800), at(0, 15000, 1600, 15400), at(0, 17450, 1600, 17900)}),
       {}});
  r.push_back({"office-graze-railing",
               "over the railing into the atrium, a little too low",
               {80, 60, mm(200)},
               along({at(1, 15000, 1050, 12050), at(1, 15000, 1150, 14500)}),
               {}});
  r.push_back({"office-graze-lamp",
               "a lamp's pole passes through the quadrilateral's inside",
               {80, 60, mm(300)},
               along({at(2, 11500, 1250, 6600), at(2, 11650, 1250, 2000)}),
               {}});
  r.push_back({"office-graze-steps",
               "close above the stairs",
               {70, 55, mm(100)},
               along({at(0, 14000, 500, 7000), at(0, 14000, 2150, 2500)}),
               {}});
  r.push_back(
      {"office-graze-slalom",
       "timed; the path swings out into the corridor's walls",
       {80, 60, mm(150)},
       facing({at(0, 2000, 1600, 9200), at(0, 2600, 1600, 10900), at(0, 8000, 1600, 10950),
               at(0, 8600, 1600, 9200), at(0, 14000, 1600, 9150), at(0, 14800, 1600, 10500)},
              kEast),
       {0, 800, 4200, 5000, 8400, 9200}});
  return r;
}

std::vector<Request> wall_requests() {
  std::vector<Request> r;
  r.push_back({"office-wall-rooms",
               "from n0 to n1 on the first floor; the way is through the corridor",
               {75, 55, mm(150)},
               along({at(1, 4000, 1500, 5900), at(1, 8800, 1500, 5900)}),
               {}});
  r.push_back({"office-wall-corridor",
               "from the corridor into s0, past its door",
               {75, 55, mm(150)},
               along({at(0, 5600, 1600, 10000), at(0, 4500, 1600, 14500)}),
               {}});
  r.push_back({"office-wall-floor",
               "through the floor slab; the stairs and the atrium are the ways round",
               {75, 55, mm(100)},
               facing({at(0, 19000, 1600, 10000), at(1, 21000, 1600, 10000)}, kEast),
               {}});
  r.push_back({"office-wall-tour",
               "four rooms on the top floor, walls between all of them",
               {70, 50, mm(100)},
               along({at(2, 26450, 1600, 5000), at(2, 21000, 1600, 14000),
                      at(2, 26900, 1600, 14500), at(2, 9750, 1600, 5600)}),
               {}});
  return r;
}

std::vector<Request> impossible_requests() {
  const Point in_safe{kSafeX, mm(680), kSafeZ};
  const Point in_shaft{(kShaftX0 + kShaftX1) / 2 - mm(100), mm(1600),
                       (kShaftZ0 + kShaftZ1) / 2 - mm(100)};
  std::vector<Request> r;
  r.push_back({"office-impossible-safe",
               "starts inside the closed safe",
               {75, 55, mm(100)},
               facing({in_safe, at(0, 25800, 1600, 13000)}, kWest),
               {}});
  r.push_back({"office-impossible-shaft",
               "visits the closed lift shaft between two free keyframes",
               {75, 55, mm(100)},
               facing({at(0, 15000, 1600, 10000), in_shaft, at(0, 20050, 1600, 9500)}, kNorth),
               {}});
  return r;
}

}  // namespace

std::vector<Request> office_requests() {
  std::vector<Request> all = free_requests();
  for (const auto& make : {graze_requests, wall_requests, impossible_requests}) {
    const std::vector<Request> more = make();
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

}  // namespace camway::make_scenes
