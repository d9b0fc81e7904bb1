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

/// A rectangle parallel to two axes, cut into cells by lines, and where a body cannot be: it may be
/// on neither a closed surface nor its other side, nor on a triangle. Conservative: a cell that is
/// called blocked holds no point where the body can be, its border included; rounding is included.
///
/// A part of the face that is connected, over pieces of lines too, and touched by no triangle is on
/// one side of the surface, that of any point in it, which is told exactly. If that is not the
/// body's side, the body is not on the border of the part either: near it, all would be on its
/// side. Touched is all that the hull of a section's corners reaches when each is moved by the
/// bound of its rounding and by the margin, and so by any triangle with corners within the margin.
class FaceGrid {
 public:
  /// Coordinates of lines, increasing; the first and the last are borders of the face.
  using Lines = std::vector<double>;

  /// The face in the plane where the coordinate `axis` is `at`. `lines` are those of the two other
  /// coordinates, (axis + 1) % 3 first. Preconditions: two lines or more each; cells() is
  /// reasonable. `margin_m`: by how much each coordinate of the vertices that are given may be off,
  /// more than the rounding of a sum with `at`; all with the same coordinates are off alike.
  FaceGrid(int axis, double at, std::array<Lines, 2> lines,
           const geometry::Vec3& margin_m = geometry::Vec3::Zero());

  [[nodiscard]] std::size_t cells() const { return blocked_.size(); }
  /// The cell between the lines `u` and `u` + 1, and `v` and `v` + 1.
  [[nodiscard]] bool is_blocked(std::size_t u, std::size_t v) const {
    return blocked_[cell(u, v)] != 0;
  }

  /// Blocks the cells of which every inner point is on the other side of the closed surface made of
  /// `triangles` than the body is. `body_is_odd`: the parity at any point of the body. Returns how
  /// many cells and triangles it looked at.
  std::size_t block(const scene::Mesh& mesh, std::span<const std::uint32_t> triangles,
                    bool body_is_odd);

  /// Blocks the cells that triangles in the plane of the face cover; where several overlap, an odd
  /// number of them. Precondition: all corners of `triangles` are in it, and really are.
  /// `exact` is the same mesh without rounding: edges are one where they are there.
  std::size_t block_flat(const scene::Mesh& mesh, const scene::Mesh& exact,
                         std::span<const std::uint32_t> triangles);

  /// Whether the `index`th cell along the border is blocked where the other coordinate, `axis`, is
  /// largest or (`at_max` false) smallest.
  [[nodiscard]] bool is_blocked_at_border(int axis, bool at_max, std::size_t index) const;

  /// (axis, at_max, index) as above: whether the body cannot be on this piece of the border, though
  /// it can in the cell.
  using BorderIsBlocked = std::function<bool(int, bool, std::size_t)>;

  /// No two points of a connected part of the face that is not blocked are further apart. Nothing
  /// if such a part reaches the border of the face where that is not blocked. [Units: metres]
  [[nodiscard]] std::optional<double> widest_hole_m(const BorderIsBlocked& border) const;

 private:
  using Point = Eigen::Vector2d;  ///< along the two axes of the face
  using Flat = Eigen::AlignedBox2d;
  /// Where a triangle meets the plane of the face, or comes within the margin of it: the hull of
  /// the points, but for rounding.
  struct Section {
    std::vector<Point> points;
    Flat bounds;
    double margin_m = 0.0;  ///< bound of all rounding until it is marked
  };
  /// Of elements: the lines have even numbers, 2 i, what is between two of them odd ones, so that
  /// an element is a cell, a piece of a line or a crossing.
  struct Window {
    int u0, v0, u1, v1;  ///< the last ones included
    [[nodiscard]] std::size_t width() const { return static_cast<std::size_t>(u1 - u0 + 1); }
    [[nodiscard]] std::size_t size() const {
      return width() * static_cast<std::size_t>(v1 - v0 + 1);
    }
    [[nodiscard]] std::size_t at(int u, int v) const {
      return static_cast<std::size_t>(v - v0) * width() + static_cast<std::size_t>(u - u0);
    }
  };
  using Element = std::pair<int, int>;

  [[nodiscard]] int element_of(int k, double x) const;
  [[nodiscard]] std::array<double, 2> ends_of(int k, int element) const;
  [[nodiscard]] int last_element(int k) const;
  [[nodiscard]] std::size_t cell(std::size_t u, std::size_t v) const {
    return v * (lines_[0].size() - 1) + u;
  }
  [[nodiscard]] Window window_of(const Flat& bounds) const;
  [[nodiscard]] Window whole() const { return {0, 0, last_element(0), last_element(1)}; }
  /// A point inside a cell of the part; nothing if there is none.
  [[nodiscard]] std::optional<Point> point_in(const std::vector<Element>& part) const;
  [[nodiscard]] geometry::Vec3 in_space(const Point& point) const;
  [[nodiscard]] double rounding_m(const geometry::Triangle& triangle) const;
  [[nodiscard]] Section section(const geometry::Triangle& triangle) const;
  void mark(const Section& section, const Window& window, std::vector<std::uint8_t>& touched) const;
  static std::vector<Element> take_part(const Window& window, Element first,
                                        std::vector<std::uint8_t>& done);
  /// Blocks the parts of what is not touched in which `is_blocked` says so of a point. Returns the
  /// number of parts.
  std::size_t block_parts(const Window& window, std::vector<std::uint8_t> touched,
                          const std::function<bool(const Point&)>& is_blocked);

  int axis_;
  double at_;
  std::array<int, 2> axes_;  ///< of the two coordinates in the face
  std::array<Lines, 2> lines_;
  geometry::Vec3 margin_m_;
  double largest_m_;  ///< coordinate of the face
  std::vector<std::uint8_t> blocked_;
};

}  // namespace camway::correction
