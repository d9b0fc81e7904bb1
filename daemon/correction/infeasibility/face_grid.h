// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::correction {

/// A rectangle parallel to two axes. Lines divide it into cells, some of which are marked as
/// blocked. The body never touches a closed surface or a triangle, and is never on the other side
/// of a closed surface. Conservative: a blocked cell, its border included, contains no point that
/// the body can occupy; rounding is included.
///
/// Proof: consider a connected region of the face that no triangle of the surface touches (pieces
/// of lines may connect it). The region lies on one side of the surface. Any point of the region
/// tells the side, which is decided exactly. If the side is not the body's, no point of the body is
/// on the border of the region either: a border point that is not on the surface has a
/// neighbourhood on one side, and the neighbourhood contains points of the region.
///
/// An *element* is a cell, a piece of a line or a crossing of two lines. The section of a triangle
/// with the face is the hull of a few corners. An element counts as touched if it is reached by the
/// hull of these corners, each moved by up to the bound of its rounding plus the margin. So an
/// element counts as touched if there is a triangle that touches it and whose corners are within
/// the margin of those given.
class FaceGrid {
 public:
  /// Coordinates of lines, increasing; the first and the last are borders of the face.
  using Lines = std::vector<double>;

  /// The face in the plane where the coordinate `axis` is `at`. `lines`: the lines of the
  /// coordinates (axis + 1) % 3 and (axis + 2) % 3. `margin_m`: bound of the error of each
  /// coordinate of the vertices that are passed later, more than the rounding of a sum with `at`;
  /// vertices with equal coordinates have equal errors. Requires two lines or more for each
  /// coordinate. Memory grows with cells().
  FaceGrid(int axis, double at, std::array<Lines, 2> lines,
           const geometry::Vec3& margin_m = geometry::Vec3::Zero());

  [[nodiscard]] std::size_t cells() const { return blocked_.size(); }
  /// The cell between the lines `u` and `u` + 1, and `v` and `v` + 1.
  [[nodiscard]] bool is_blocked(std::size_t u, std::size_t v) const {
    return blocked_[cell(u, v)] != 0;
  }

  /// Blocks the cells whose inner points are all on the other side of the closed surface made of
  /// `triangles` than the body. `body_is_odd`: the parity at any point of the body. Returns the
  /// number of cells and triangles examined.
  std::size_t block(const scene::Mesh& mesh, std::span<const std::uint32_t> triangles,
                    bool body_is_odd);

  /// Blocks the cells that triangles in the plane of the face cover. Copies of a triangle count
  /// once. Where different triangles overlap, blocks only the cells that an odd number of them
  /// covers. Requires all corners of `triangles` to be exactly in the plane. `exact`: the same mesh
  /// without rounding; two edges with the same ends in `exact` count as one edge. Returns the
  /// number of cells and triangles examined.
  std::size_t block_flat(const scene::Mesh& mesh, const scene::Mesh& exact,
                         std::span<const std::uint32_t> triangles);

  /// Whether the cell with this index along the border is blocked. The border is where the other
  /// coordinate, `axis`, is largest (`at_max`) or smallest.
  [[nodiscard]] bool is_blocked_at_border(int axis, bool at_max, std::size_t index) const;

  /// Takes (axis, at_max, index) as `is_blocked_at_border`. Returns whether the body cannot be on
  /// this piece of the border, even if it can be in the cell.
  using BorderIsBlocked = std::function<bool(int, bool, std::size_t)>;

  /// Returns a bound of the distance of two points in one connected unblocked part of the face.
  /// Returns nothing if such a part reaches an unblocked piece of the border. [Units: metres]
  [[nodiscard]] std::optional<double> widest_hole_m(const BorderIsBlocked& border) const;

 private:
  using Point = Eigen::Vector2d;  ///< coordinates along the two axes of the face
  using Flat = Eigen::AlignedBox2d;
  /// The intersection of a triangle with the slab within the margin of the face's plane: the hull
  /// of `points`, up to rounding.
  struct Section {
    std::vector<Point> points;
    Flat bounds;
    double margin_m = 0.0;  ///< bound of all rounding until the section is marked
  };
  /// A rectangle of elements. Along each axis lines have even numbers 2 i and the ranges between
  /// them odd ones, so an element is a cell, a piece of a line or a crossing.
  struct Window {
    int u0, v0, u1, v1;  ///< ranges of elements, the last ones included
    [[nodiscard]] std::size_t width() const { return static_cast<std::size_t>(u1 - u0 + 1); }
    [[nodiscard]] std::size_t size() const {
      return width() * static_cast<std::size_t>(v1 - v0 + 1);
    }
    [[nodiscard]] std::size_t at(int u, int v) const {
      return static_cast<std::size_t>(v - v0) * width() + static_cast<std::size_t>(u - u0);
    }
  };
  /// Neighbouring elements of a row.
  struct Run {
    int v, u0, u1;  ///< the row, and the first and last element
  };

  [[nodiscard]] int element_of(int k, double x) const;
  [[nodiscard]] std::array<double, 2> ends_of(int k, int element) const;
  [[nodiscard]] int last_element(int k) const;
  [[nodiscard]] std::size_t cell(std::size_t u, std::size_t v) const {
    return v * (lines_[0].size() - 1) + u;
  }
  [[nodiscard]] Window window_of(const Flat& bounds) const;
  [[nodiscard]] Window whole() const { return {0, 0, last_element(0), last_element(1)}; }
  /// Returns a point inside a cell of the part; nothing if there is none.
  [[nodiscard]] std::optional<Point> point_in(const std::vector<Run>& part) const;
  [[nodiscard]] geometry::Vec3 in_space(const Point& point) const;
  [[nodiscard]] double rounding_m(const geometry::Triangle& triangle) const;
  [[nodiscard]] Section section(const geometry::Triangle& triangle) const;
  void mark(const Section& section, const Window& window, std::vector<std::uint8_t>& touched) const;
  /// Marks the elements that are not done about (u, v) in its row as done, and returns them.
  static Run take_run(const Window& window, int u, int v, std::vector<std::uint8_t>& done);
  /// Does this for all elements that are connected with (u, v) by elements that are not done.
  static std::vector<Run> take_part(const Window& window, int u, int v,
                                    std::vector<std::uint8_t>& done);
  /// Blocks each connected untouched part for one of whose points `is_blocked` returns true.
  /// Returns the number of parts.
  std::size_t block_parts(const Window& window, std::vector<std::uint8_t> touched,
                          const std::function<bool(const Point&)>& is_blocked);

  int axis_;
  double at_;
  std::array<int, 2> axes_;  ///< axes of the two coordinates in the face
  std::array<Lines, 2> lines_;
  geometry::Vec3 margin_m_;
  double largest_m_;  ///< largest absolute coordinate of the face
  std::vector<std::uint8_t> blocked_;
};

}  // namespace camway::correction
