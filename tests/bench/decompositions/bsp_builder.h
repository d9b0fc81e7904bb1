// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/geometry/rounding.h"
#include "tests/bench/decompositions/bsp_tree.h"

namespace camway::bench {

/// Bounds of rounding in units of 2^-53 of the largest coordinate L, for the scene and the body.
///
/// A height above a plane is wrong by at most 16: a dot product has 4 roundings of terms that sum
/// to at most √3·L, the offset and the difference have one each. The normal's length is wrong by a
/// few units, which adds as much again to a distance (32 in all).
///
/// A point where an edge meets a plane lies within 16 of the edge (`scene::TriangleCutter` counts
/// the roundings) and, as its parameter is the quotient of two heights, within 64 of the plane.
/// Vertices within 64 of a plane count as in it.
///
/// So a vertex of a piece is on the wrong side of a plane above it by at most 64, plus 16 for each
/// cut below that plane; and each cut loses at most 16 of the triangle's edge. With `d` levels that
/// is 64 + 2·16·d from any point of the triangle to a piece and its half-spaces, 96 + 32·d with the
/// height of the body's vertices; 128 leaves room for the second order.
inline constexpr double kInPlaneUnits = 64.0;
inline constexpr double kBspErrorUnits = 128.0;
inline constexpr double kBspErrorUnitsOfLevel = 32.0;

/// Largest coordinate of a box, without its sign.
inline double largest_m(const geometry::Box& box) {
  return box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
}

/// Builds a BSP tree, depth first.
/// Not thread-safe.
class BspBuilder {
 public:
  BspBuilder(BspTree& tree, const BspOptions& options);

  /// Fills the tree, which has a mesh and its bounds.
  void build();

 private:
  /// The part of a triangle in a cell.
  struct Piece {
    std::uint32_t triangle = 0;
    std::vector<geometry::Vec3> corners;  ///< of a convex polygon, in order
  };
  using Pieces = std::vector<Piece>;
  /// How a plane divides pieces.
  struct Shares {
    std::size_t behind = 0;
    std::size_t in_front = 0;
    std::size_t cut = 0;

    [[nodiscard]] std::size_t larger() const { return std::max(behind, in_front) + cut; }
  };
  struct Division {
    Pieces behind;
    Pieces in_front;
    std::vector<std::uint32_t> in_plane;
  };
  /// Range of the heights of a piece above a plane.
  struct Heights {
    double low_m = 0.0;
    double high_m = 0.0;
  };

  std::uint32_t build_child(Pieces pieces, double budget, std::uint32_t depth);
  std::uint32_t add_leaf(const Pieces& pieces);
  BspTree::Range add_references(const std::vector<std::uint32_t>& triangles);

  [[nodiscard]] std::optional<BspPlane> plane_for(const Pieces& pieces) const;
  [[nodiscard]] std::optional<BspPlane> plane_of(const Piece& piece) const;
  [[nodiscard]] Shares shares_of(const BspPlane& plane, const Pieces& pieces) const;
  [[nodiscard]] Division divided(const BspPlane& plane, Pieces pieces) const;
  static Heights heights_of(const BspPlane& plane, const Piece& piece);
  static BspPlane middle_plane(const Pieces& pieces);
  static std::array<Piece, 2> cut(const BspPlane& plane, const Piece& piece);

  BspTree& tree_;
  BspOptions options_;
  double in_plane_m_;  ///< height below which a vertex counts as in a plane
};

}  // namespace camway::bench
