// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "daemon/correction/path/free_space.h"
#include "daemon/correction/search/cell_options.h"
#include "daemon/correction/search/closed_corner.h"

namespace camway::correction {

/// Index of no cell.
inline constexpr std::uint32_t kNoCell = std::numeric_limits<std::uint32_t>::max();

enum class CellState : std::uint8_t {
  kFree,     ///< the centre of the ball is free everywhere in the cell
  kMixed,    ///< neither of the others is proved
  kBlocked,  ///< the centre of the ball is free nowhere in the cell
};

/// Number of ends of a way: the begin is end 0, the end is end 1.
inline constexpr std::size_t kCellEnds = 2;

/// A set of ends of a way.
class EndSet {
 public:
  [[nodiscard]] bool has(std::size_t end) const { return (bits_ >> end & 1U) != 0; }
  [[nodiscard]] bool empty() const { return bits_ == 0; }
  void add(std::size_t end) { bits_ = static_cast<std::uint8_t>(bits_ | 1U << end); }
  void remove(std::size_t end) { bits_ = static_cast<std::uint8_t>(bits_ & ~(1U << end)); }

 private:
  std::uint8_t bits_ = 0;
};

/// A place among cells of one size: the distances from the corner of the whole, in sides of a cell.
using CellPlace = std::array<std::int32_t, 3>;

struct OctreeCell {
  CellPlace at{};
  std::uint32_t children = kNoCell;  ///< the first of eight
  float gap_m = 0.0F;                ///< of the ball in the middle, for free cells
  std::int8_t level = 0;             ///< how often the whole was divided
  CellState state = CellState::kMixed;
  EndSet reached;  ///< from which ends
  EndSet waiting;  ///< for which ends the cell waits to be divided

  [[nodiscard]] bool is_divided() const { return children != kNoCell; }
};

/// A cube, divided as an octree as far as a search asks (`cell_search.h`), with what is known of
/// the centre of a ball in each cell. Cells keep their indices; those that are not divided fill the
/// cube.
class CellTree {
 public:
  /// The cube has the middle of `around` and its longest side. Refers to `space` and `options`,
  /// which must outlive it.
  CellTree(const FreeSpace& space, const CellOptions& options, const geometry::Box& around);

  /// Number of cells, those that are divided included.
  [[nodiscard]] std::size_t size() const { return cells_.size(); }
  OctreeCell& operator[](std::uint32_t index) { return cells_[index]; }
  const OctreeCell& operator[](std::uint32_t index) const { return cells_[index]; }

  [[nodiscard]] double side_m(int level) const { return std::ldexp(side_m_, -level); }
  [[nodiscard]] geometry::Vec3 center_W(const OctreeCell& cell) const;
  [[nodiscard]] bool may_divide(const OctreeCell& cell) const;

  /// Returns the closed corner that a cell stands in, as seen from the middle of the cell beside
  /// it, with room for further cells of that size in front. Returns nothing if there is none.
  [[nodiscard]] std::optional<ClosedCorner> corner_at(const OctreeCell& cell,
                                                      const OctreeCell& beside) const;

  /// Gap of the ball in the middle of a cell, as far as it is less than `horizon_m`.
  [[nodiscard]] double gap_m(const OctreeCell& cell, double horizon_m) const;

  /// Divides a cell into eight and returns the first of them. References to cells become invalid.
  std::uint32_t divide(std::uint32_t index);

  /// Returns the free cell that holds a point; divides cells until there is one. Returns nothing if
  /// the smallest cell about the point is not free.
  std::optional<std::uint32_t> free_cell_at(const geometry::Vec3& point_W);

  /// Calls `visit(neighbour)` for each undivided cell on the other side of a face.
  template <class Visit>
  void for_each_neighbour(std::uint32_t index, const Visit& visit) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const std::int32_t step : {-1, 1}) {
        CellPlace at = cells_[index].at;
        at[axis] += step;
        if (at[axis] < 0 || at[axis] >> cells_[index].level != 0) continue;
        visit_face(cell_at(at, cells_[index].level), axis, step, visit);
      }
    }
  }

 private:
  /// The cell there, or an undivided one that holds it.
  [[nodiscard]] std::uint32_t cell_at(const CellPlace& at, int level) const;

  /// Visits the undivided cells within a cell at the face through which a step enters it.
  template <class Visit>
  void visit_face(std::uint32_t index, std::size_t axis, std::int32_t step,
                  const Visit& visit) const {
    if (!cells_[index].is_divided()) {
      visit(index);
      return;
    }
    for (std::uint32_t i = 0; i < 8; ++i) {
      if ((i >> axis & 1U) == (step > 0 ? 0U : 1U))
        visit_face(cells_[index].children + i, axis, step, visit);
    }
  }

  void classify(OctreeCell& cell) const;

  const FreeSpace& space_;
  const CellOptions& options_;
  double side_m_;
  geometry::Vec3 low_W_;
  std::vector<OctreeCell> cells_;
};

}  // namespace camway::correction
