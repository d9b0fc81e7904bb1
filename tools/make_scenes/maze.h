// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "tools/make_scenes/solid.h"

namespace camway::make_scenes {

/// A maze of square cells. A few walls are left out, so that several ways join two cells.
class Maze {
 public:
  static constexpr int kColumns = 10;
  static constexpr int kRows = 8;
  static constexpr Um kPitch = mm(2000);     ///< distance between the centres of adjacent cells
  static constexpr Um kThickness = mm(200);  ///< thickness of walls, floor and ceiling
  static constexpr Um kHeight = mm(2400);

  struct Cell {
    int column;
    int row;
    bool operator==(const Cell&) const = default;
  };

  /// Makes the maze that follows from a random seed.
  explicit Maze(std::uint64_t seed);

  /// Returns walls, floor and ceiling as a scene.
  [[nodiscard]] Scene scene() const;

  /// Returns whether no wall separates `a` from the adjacent cell `b`.
  [[nodiscard]] bool open(const Cell& a, const Cell& b) const;

  /// Returns a shortest way from `from` to `to`, both included.
  [[nodiscard]] std::vector<Cell> way(const Cell& from, const Cell& to) const;

  /// Returns the centre of a cell at a height above the floor.
  static Point middle(const Cell& cell, Um y);

 private:
  static constexpr std::size_t kCells = std::size_t{kColumns} * kRows;

  static bool inside(const Cell& cell);
  static std::size_t index(const Cell& cell);
  void join(const Cell& a, const Cell& b);
  void carve(const Cell& from, Dice& dice, std::array<bool, kCells>& visited);

  std::array<bool, kCells> open_east_{};
  std::array<bool, kCells> open_south_{};
};

}  // namespace camway::make_scenes
