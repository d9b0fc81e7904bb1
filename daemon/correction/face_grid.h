// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/mesh.h"

namespace camway::correction {

/// A face of an axis-parallel box, cut into cells, and where a body that is outside some closed
/// surfaces cannot be. Conservative: what is called blocked is, rounding included; cells that a
/// surface passes through are not.
class FaceGrid {
 public:
  /// The face of `box` whose normal is along `axis`, at the coordinate `at`; cells of at most
  /// `cell_m`. Preconditions: the box has volume; cells() is reasonable.
  FaceGrid(const geometry::Box& box, int axis, double at, double cell_m);

  [[nodiscard]] std::size_t cells() const { return blocked_.size(); }

  /// Blocks the cells of which every point is on the other side of the closed surface made of
  /// `triangles` than the body is. `body_is_odd`: the parity at any point of the body. What lies
  /// outside the bounds of the surface is left as it is. Returns how many cells and triangles it
  /// looked at.
  std::size_t block(const scene::Mesh& mesh, std::span<const std::uint32_t> triangles,
                    bool body_is_odd);

  /// No two points of a connected part of the face that is not blocked are further apart. Nothing
  /// if such a part reaches the border of the face. [Units: metres]
  [[nodiscard]] std::optional<double> widest_hole_m() const;

 private:
  struct Window {
    int u0, v0, u1, v1;  ///< cells, the last ones included
    [[nodiscard]] std::size_t width() const { return static_cast<std::size_t>(u1 - u0 + 1); }
    [[nodiscard]] std::size_t at(int u, int v) const {
      return static_cast<std::size_t>(v - v0) * width() + static_cast<std::size_t>(u - u0);
    }
  };
  using Cell = std::pair<int, int>;
  using Point = Eigen::Vector2d;  ///< along the two axes of the face
  /// Where a triangle meets the plane of the face: the hull of the points, but for rounding.
  struct Section {
    std::vector<Point> points;
    double margin_m = 0.0;  ///< bound of all rounding from the triangle to the numbers of cells
  };

  [[nodiscard]] int cell_of(int k, double x) const;
  [[nodiscard]] std::size_t cell(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(count_[0]) +
           static_cast<std::size_t>(u);
  }
  [[nodiscard]] geometry::Vec3 middle_of(int u, int v) const;
  [[nodiscard]] Section section(const geometry::Triangle& triangle) const;
  /// The cells that are connected with `first` and not done; does them.
  static std::vector<Cell> take_part(const Window& window, Cell first,
                                     std::vector<std::uint8_t>& done);
  void mark(const Section& section, const Window& window, std::vector<std::uint8_t>& touched) const;

  int axis_;
  double at_;
  std::array<int, 2> axes_;  ///< of the two coordinates in the face
  std::array<double, 2> low_;
  std::array<double, 2> step_;
  std::array<int, 2> count_;
  double largest_m_;  ///< coordinate of the face
  std::vector<std::uint8_t> blocked_;
};

}  // namespace camway::correction
