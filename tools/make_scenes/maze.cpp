// SPDX-License-Identifier: MIT
#include "tools/make_scenes/maze.h"

#include <algorithm>
#include <cstdlib>
#include <string>

namespace camway::make_scenes {
namespace {

constexpr std::array<Maze::Cell, 4> kSides{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

Maze::Cell moved(const Maze::Cell& cell, const Maze::Cell& step) {
  return {cell.column + step.column, cell.row + step.row};
}

}  // namespace

Maze::Maze(std::uint64_t seed) {
  Dice dice(seed);
  std::array<bool, kCells> visited{};
  carve({0, 0}, dice, visited);
  for (int extra = 0; extra < 10; ++extra) {
    const Cell cell{static_cast<int>(dice.below(kColumns - 1)),
                    static_cast<int>(dice.below(kRows - 1))};
    join(cell, moved(cell, kSides[static_cast<std::size_t>(dice.below(2))]));
  }
}

bool Maze::inside(const Cell& cell) {
  return cell.column >= 0 && cell.column < kColumns && cell.row >= 0 && cell.row < kRows;
}

std::size_t Maze::index(const Cell& cell) {
  return static_cast<std::size_t>(cell.row * kColumns + cell.column);
}

void Maze::join(const Cell& a, const Cell& b) {
  const bool along_row = a.row == b.row;
  const Cell& first = along_row ? (a.column < b.column ? a : b) : (a.row < b.row ? a : b);
  (along_row ? open_east_ : open_south_)[index(first)] = true;
}

/// Opens walls by a depth-first search in random order. Its depth is at most the number of cells.
void Maze::carve(const Cell& from, Dice& dice, std::array<bool, kCells>& visited) {
  visited[index(from)] = true;
  std::array<Cell, 4> steps = kSides;
  for (std::size_t left = steps.size(); left > 0; --left) {
    std::swap(steps[left - 1],
              steps[static_cast<std::size_t>(dice.below(static_cast<std::int64_t>(left)))]);
    const Cell next = moved(from, steps[left - 1]);
    if (!inside(next) || visited[index(next)]) continue;
    join(from, next);
    carve(next, dice, visited);
  }
}

bool Maze::open(const Cell& a, const Cell& b) const {
  if (!inside(a) || !inside(b)) return false;
  const bool along_row = a.row == b.row;
  const Cell first{std::min(a.column, b.column), std::min(a.row, b.row)};
  return (along_row ? open_east_ : open_south_)[index(first)];
}

std::vector<Maze::Cell> Maze::way(const Cell& from, const Cell& to) const {
  // Breadth first from the goal; then follow the predecessors forwards.
  std::array<Cell, kCells> next{};
  std::array<bool, kCells> seen{};
  std::vector<Cell> queue{to};
  seen[index(to)] = true;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const Cell here = queue[i];
    for (const Cell& step : kSides) {
      const Cell neighbour = moved(here, step);
      if (!open(here, neighbour) || seen[index(neighbour)]) continue;
      seen[index(neighbour)] = true;
      next[index(neighbour)] = here;
      queue.push_back(neighbour);
    }
  }
  std::vector<Cell> result{from};
  while (!(result.back() == to)) result.push_back(next[index(result.back())]);
  return result;
}

Point Maze::middle(const Cell& cell, Um y) {
  return {cell.column * kPitch + kPitch / 2, y, cell.row * kPitch + kPitch / 2};
}

Scene Maze::scene() const {
  Scene scene;
  const Um half = kThickness / 2;
  const Um x1 = kColumns * kPitch + half;
  const Um z1 = kRows * kPitch + half;
  scene.begin_object("floor");
  add_slab(scene, {-half, x1, -half, z1, -kThickness, 0});
  scene.begin_object("ceiling");
  add_slab(scene, {-half, x1, -half, z1, kHeight, kHeight + kThickness});
  for (int row = 0; row <= kRows; ++row) {
    for (int column = 0; column <= kColumns; ++column) {
      const std::string place = std::to_string(column) + '_' + std::to_string(row);
      const Um x = column * kPitch;
      const Um z = row * kPitch;
      scene.begin_object("post_" + place);
      scene.add_box({}, {x - half, 0, z - half}, {x + half, kHeight, z + half});
      // The entrance is the west side of the first cell, the exit the east side of the last.
      const bool entrance = (column == 0 && row == 0) || (column == kColumns && row == kRows - 1);
      if (row < kRows && !entrance && !open({column - 1, row}, {column, row})) {
        scene.begin_object("wall_west_" + place);
        scene.add_box({}, {x - half, 0, z + half}, {x + half, kHeight, z + kPitch - half});
      }
      if (column < kColumns && !open({column, row - 1}, {column, row})) {
        scene.begin_object("wall_north_" + place);
        scene.add_box({}, {x + half, 0, z - half}, {x + kPitch - half, kHeight, z + half});
      }
    }
  }
  return scene;
}

}  // namespace camway::make_scenes
