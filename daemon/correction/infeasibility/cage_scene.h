// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/mesh/closed_surfaces.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::correction {

/// A closed surface of a scene.
struct Barrier {
  std::vector<std::uint32_t> triangles;  ///< triangles of the surface, increasing
  geometry::Box box;
  /// Whether the surface is a bar: the two smaller sides of `box` are less than the shortest chord,
  /// and the largest is at least `kLeastSlenderness` times the smallest, which is more than 0.
  bool is_bar = false;
  /// Whether every triangle lies in a plane that is perpendicular to an axis; always false in a
  /// turned frame.
  bool is_stepped = false;
  [[nodiscard]] double thickness_m() const { return box.sizes().minCoeff(); }
};

/// A triangle in a plane perpendicular to an axis.
struct FlatTriangle {
  double at = 0.0;  ///< coordinate of all its corners
  std::uint32_t triangle = 0;
};

/// A scene that is prepared for the search for cages. Its frame has axes to which bars of the scene
/// are parallel.
class CageScene {
 public:
  /// Prepares the scene in the frame of the world. Refers to `mesh`, which must outlive it.
  CageScene(const scene::Mesh& mesh, const scene::ClosedSurfaces& surfaces,
            double shortest_chord_m);
  /// Prepares the scene in a frame that is turned about an axis of the world by `angle_rad`, which
  /// is not 0. Refers to `mesh`, which must outlive it.
  CageScene(const scene::Mesh& mesh, const scene::ClosedSurfaces& surfaces, double shortest_chord_m,
            int axis, double angle_rad);

  /// The mesh in the frame, with rounded vertices.
  [[nodiscard]] const scene::Mesh& mesh() const { return is_turned() ? turned_ : *original_; }
  /// Returns the mesh in the frame of the world. Two of its vertices have equal coordinates if and
  /// only if they are the same point; in `mesh()`, rounding may make different points equal.
  [[nodiscard]] const scene::Mesh& original() const { return *original_; }
  /// Returns, for each axis, a bound of the difference between the coordinate of a vertex of
  /// `mesh()` and that of its exact image in the frame. The exact frame differs from
  /// `orientation()` by a few roundings of the angle. The bound is 0 along the axis of the turn,
  /// and on all axes if the frame is not turned.
  [[nodiscard]] const geometry::Vec3& margin_m() const { return margin_m_; }
  [[nodiscard]] const std::vector<Barrier>& barriers() const { return barriers_; }
  /// The triangles in planes perpendicular to an axis, by increasing coordinate. In a turned frame
  /// only the axis of the turn has some: its coordinates are not rounded.
  [[nodiscard]] const std::vector<FlatTriangle>& flats(int axis) const {
    return flats_[static_cast<std::size_t>(axis)];
  }
  /// Rotation from the frame to the world.
  [[nodiscard]] geometry::Quat orientation() const;
  [[nodiscard]] geometry::Vec3 in_frame(const geometry::Vec3& point_W) const;
  /// Index of a barrier that contains the triangle; kNoIndex if there is none.
  [[nodiscard]] std::uint32_t barrier_of(std::uint32_t triangle) const {
    return barrier_of_[triangle];
  }

 private:
  void add_barriers(const scene::ClosedSurfaces& surfaces, double shortest_chord_m);
  void add_flats(int axis);
  [[nodiscard]] bool is_turned() const { return angle_rad_ != 0.0; }

  const scene::Mesh* original_;
  int axis_ = 2;
  double angle_rad_ = 0.0;
  double cosine_ = 1.0;
  double sine_ = 0.0;
  geometry::Vec3 margin_m_ = geometry::Vec3::Zero();
  scene::Mesh turned_;
  std::vector<Barrier> barriers_;
  std::vector<std::uint32_t> barrier_of_;  ///< barrier of each triangle
  std::array<std::vector<FlatTriangle>, 3> flats_;
};

/// Returns the scene in the frame of the world, and in at most two turned frames. A turned frame is
/// rotated about one axis of the world. For each turn, the closed surfaces of at most
/// `kMostTrianglesOfBar` triangles count that have a triangle perpendicular to one of the two
/// turned axes; the turns with the most such surfaces are chosen. A turn with fewer of them than a
/// face needs (`kLeastBars`) is left out. The result refers to `mesh`, which must outlive it.
std::vector<CageScene> cage_scenes(const scene::Mesh& mesh, const scene::ClosedSurfaces& surfaces,
                                   double shortest_chord_m);

/// Candidate boxes for cages around a point, likely ones first.
class CageBoxes {
 public:
  static constexpr std::size_t kMost = 9;  ///< largest number of boxes around a point

  /// Refers to `scene`, which must outlive it.
  explicit CageBoxes(const CageScene& scene);
  [[nodiscard]] std::vector<geometry::Box> around(const geometry::Vec3& center) const;

 private:
  /// A plane that contains the centres of bars.
  struct Plane {
    double at = 0.0;
    std::size_t bars = 0;
  };
  /// For each axis a coordinate below and one above the point.
  using Sides = std::array<std::array<std::optional<double>, 2>, 3>;

  [[nodiscard]] std::vector<Plane> planes(int axis) const;
  /// Returns the nearest planes that have enough bars: at least `share` times as many as the plane
  /// with the most bars on that side of the point.
  [[nodiscard]] Sides nearest_planes(const geometry::Vec3& center, double share) const;
  [[nodiscard]] Sides nearest_flats(const geometry::Vec3& center) const;

  const CageScene& scene_;
  std::array<std::vector<Plane>, 3> planes_;
};

}  // namespace camway::correction
