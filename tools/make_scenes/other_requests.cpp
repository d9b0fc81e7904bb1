// SPDX-License-Identifier: MIT
#include <stdexcept>

#include "tools/make_scenes/catalogue.h"
#include "tools/make_scenes/gallery.h"
#include "tools/make_scenes/maze.h"

namespace camway::make_scenes {
namespace {

constexpr Um kMazeEye = mm(1200);

std::vector<Point> middles(const std::vector<Maze::Cell>& cells) {
  std::vector<Point> points;
  for (const Maze::Cell& cell : cells) points.push_back(Maze::middle(cell, kMazeEye));
  return points;
}

/// Returns `way` without the cells in which it changes direction.
std::vector<Maze::Cell> without_corners(const std::vector<Maze::Cell>& way) {
  std::vector<Maze::Cell> result{way.front()};
  for (std::size_t i = 1; i + 1 < way.size(); ++i) {
    const bool turns = way[i - 1].row != way[i + 1].row && way[i - 1].column != way[i + 1].column;
    if (!turns) result.push_back(way[i]);
  }
  result.push_back(way.back());
  return result;
}

/// Returns two adjacent cells with a wall between them and the longest way around it of at most
/// `limit` steps.
std::vector<Maze::Cell> walled_neighbours(const Maze& maze, std::size_t limit) {
  std::vector<Maze::Cell> best;
  for (int row = 0; row < Maze::kRows; ++row) {
    for (int column = 0; column + 1 < Maze::kColumns; ++column) {
      const Maze::Cell a{column, row};
      const Maze::Cell b{column + 1, row};
      if (maze.open(a, b)) continue;
      std::vector<Maze::Cell> way = maze.way(a, b);
      if (way.size() <= limit && way.size() > best.size()) best = way;
    }
  }
  if (best.empty()) throw std::logic_error("no walled neighbours in the maze");
  return best;
}

Point exhibit(Um x, std::int64_t dx, std::int64_t y, std::int64_t z) {
  return {x + mm(dx), mm(y), mm(z)};
}

std::vector<Request> ways_past_exhibits() {
  using namespace gallery;
  std::vector<Request> r;
  r.push_back({"gallery-free-aisle",
               "past all exhibits along the free strip",
               {80, 60, mm(150)},
               along({exhibit(0, 1000, 1600, 3450), exhibit(0, 12000, 1500, 3500),
                      exhibit(0, 24000, 1700, 3400), exhibit(0, 33000, 1600, 3450)}),
               {}});
  r.push_back({"gallery-free-ring",
               "through the middle of the ring",
               {70, 60, mm(150)},
               along({exhibit(kRingX, -2000, 1600, 2000), exhibit(kRingX, 1500, 1600, 2000)}),
               {}});
  return r;
}

std::vector<Request> exhibits_in_the_middle() {
  using namespace gallery;
  std::vector<Request> r;
  r.push_back({"gallery-graze-cube",
               "the swept tube encloses the cube, no side of it touches",
               {90, 70, mm(400)},
               along({exhibit(kCubeX, -1800, 1600, 2000), exhibit(kCubeX, 1500, 1600, 2000)}),
               {}});
  r.push_back({"gallery-graze-spike",
               "a spike from below ends inside the tube",
               {80, 60, mm(300)},
               along({exhibit(kPolesX, 1000, 1550, 2000), exhibit(kPolesX, 2600, 1550, 2000)}),
               {}});
  r.push_back({"gallery-graze-poles",
               "poles cross the quadrilateral's inside",
               {80, 60, mm(250)},
               along({exhibit(kPolesX, -2000, 1600, 1700), exhibit(kPolesX, 2300, 1400, 2500)}),
               {}});
  r.push_back({"gallery-graze-wires",
               "wires of 1 mm cross the quadrilateral",
               {80, 60, mm(150)},
               along({exhibit(kWiresX, -2000, 1350, 1500), exhibit(kWiresX, 2200, 1600, 2300)}),
               {}});
  r.push_back(
      {"gallery-graze-triangles",
       "single triangles, facing and level",
       {80, 60, mm(200)},
       along({exhibit(kTrianglesX, -1500, 1500, 1900), exhibit(kTrianglesX, 2500, 1600, 2400)}),
       {}});
  return r;
}

std::vector<Request> exhibits_at_the_end() {
  using namespace gallery;
  std::vector<Request> r;
  r.push_back({"gallery-graze-plate",
               "a plate without thickness, met edge-on in its own plane",
               {80, 60, mm(200)},
               along({exhibit(kPlatesX, -1800, 1600, 2000), exhibit(kPlatesX, 1500, 1600, 2000)}),
               {}});
  r.push_back({"gallery-graze-ring",
               "through the ring, off its middle",
               {80, 60, mm(250)},
               along({exhibit(kRingX, -2000, 1600, 2350), exhibit(kRingX, 1600, 1500, 2450)}),
               {}});
  r.push_back({"gallery-graze-fan",
               "through the fan and above the slivers",
               {80, 60, mm(150)},
               along({exhibit(kFanX, -2200, 1500, 1800), exhibit(kFanX, 3400, 1300, 2300)}),
               {}});
  r.push_back({"gallery-graze-rod",
               "a rod points at the camera and pierces the quadrilateral's inside",
               {80, 60, mm(350)},
               along({exhibit(kSlotX, -3000, 1600, 2800), exhibit(kSlotX, -700, 1600, 2500)}),
               {}});
  r.push_back({"gallery-wall-louvre",
               "through the slats of the louvre; the way is beside it",
               {75, 55, mm(150)},
               along({exhibit(kLouvreX, -1500, 1600, 1100), exhibit(kLouvreX, 1500, 1600, 1100)}),
               {}});
  return r;
}

std::vector<Request> ways_through_the_slot() {
  using namespace gallery;
  std::vector<Request> r;
  const Direction east{1, 0, 0};
  r.push_back(
      {"gallery-wall-slot",
       "through a slot that is narrower than the camera is wide: it must roll",
       {90, 50, mm(200)},
       facing({exhibit(kSlotX, -1500, 1400, 2000), exhibit(kSlotX, 1500, 1400, 2000)}, east),
       {}});
  const Quaternion rolled = rolled_90(look_along(east));
  r.push_back({"gallery-free-slot",
               "through the same slot, rolled by a quarter turn",
               {90, 50, mm(200)},
               {{exhibit(kSlotX, -1500, 1400, 1200), rolled},
                {exhibit(kSlotX, 0, 1400, 1200), rolled},
                {exhibit(kSlotX, 1500, 1400, 1200), rolled}},
               {0, 1500, 3000}});
  return r;
}

}  // namespace

std::vector<Request> maze_requests() {
  const Maze maze(kMazeSeed);
  const Maze::Cell first{0, 0};
  const Maze::Cell last{Maze::kColumns - 1, Maze::kRows - 1};
  std::vector<Maze::Cell> way = maze.way(first, last);
  const std::vector<Maze::Cell> beginning(way.begin(), way.begin() + 10);
  const std::vector<Maze::Cell> round = walled_neighbours(maze, 9);
  std::vector<Request> r;
  r.push_back({"maze-free-cells",
               "cell by cell from the entrance",
               {75, 55, mm(80)},
               along(middles(beginning)),
               {}});
  r.push_back({"maze-graze-corners",
               "the same way without the cells where it turns: cuts corners",
               {75, 55, mm(80)},
               along(middles(without_corners(beginning))),
               {}});
  r.push_back({"maze-wall-neighbours",
               "two neighbouring cells, a wall between them",
               {75, 55, mm(120)},
               along(middles({round.front(), round.back()})),
               {}});
  r.push_back({"maze-wall-through",
               "from the entrance to the exit, the whole maze between",
               {75, 55, mm(120)},
               along(middles({first, last})),
               {}});
  return r;
}

std::vector<Request> gallery_requests() {
  std::vector<Request> all = ways_past_exhibits();
  for (const auto& more :
       {exhibits_in_the_middle(), exhibits_at_the_end(), ways_through_the_slot()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

}  // namespace camway::make_scenes
