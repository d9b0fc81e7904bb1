// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "daemon/correction/infeasibility/closed_surfaces.h"
#include "daemon/geometry/types.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::correction {

/// A closed surface of a scene.
struct Barrier {
  std::vector<std::uint32_t> triangles;  ///< increasing
  geometry::Box box;
  bool is_bar = false;      ///< long, and in two directions thinner than the body's shortest chord
  bool is_stepped = false;  ///< all its triangles are parallel to two axes
  [[nodiscard]] double thickness_m() const { return box.sizes().minCoeff(); }
};

/// A triangle in a plane across an axis.
struct FlatTriangle {
  double at = 0.0;  ///< the coordinate of all its corners
  std::uint32_t triangle = 0;
};

/// A scene as searches for cages see it: in a frame that bars are parallel to.
class CageScene {
 public:
  /// In the frame of the world. Refers to `mesh`, which must outlive it.
  CageScene(const scene::Mesh& mesh, const ClosedSurfaces& surfaces, double shortest_chord_m);
  /// In a frame that is turned about an axis of the world.
  CageScene(const scene::Mesh& mesh, const ClosedSurfaces& surfaces, double shortest_chord_m,
            int axis, double angle_rad);

  /// In the frame.
  [[nodiscard]] const scene::Mesh& mesh() const { return is_turned() ? turned_ : *original_; }
  /// In the frame of the world: what is one point here is one, unlike what was rounded.
  [[nodiscard]] const scene::Mesh& original() const { return *original_; }
  /// How far coordinates may be off, for rounding, from a frame that is as turned as `orientation`
  /// but for a few roundings. 0 along the axis that it is turned about, and in the world's frame.
  [[nodiscard]] const geometry::Vec3& margin_m() const { return margin_m_; }
  [[nodiscard]] const std::vector<Barrier>& barriers() const { return barriers_; }
  /// Across an axis, in order of their coordinates. Where the frame is turned, only across the axis
  /// that it is turned about: those coordinates are not rounded.
  [[nodiscard]] const std::vector<FlatTriangle>& flats(int axis) const {
    return flats_[static_cast<std::size_t>(axis)];
  }
  /// Of the frame, into the world.
  [[nodiscard]] geometry::Quat orientation() const;
  [[nodiscard]] geometry::Vec3 in_frame(const geometry::Vec3& point_W) const;
  [[nodiscard]] std::size_t bars() const;
  /// A number of a barrier that the triangle is of; kNoIndex if there is none.
  [[nodiscard]] std::uint32_t barrier_of(std::uint32_t triangle) const {
    return barrier_of_[triangle];
  }

 private:
  void add_barriers(const ClosedSurfaces& surfaces, double shortest_chord_m);
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
  std::vector<std::uint32_t> barrier_of_;  ///< by triangle
  std::array<std::vector<FlatTriangle>, 3> flats_;
};

/// The scene in the frame of the world and in those, turned about one axis of it, that the most of
/// its thin closed surfaces are parallel to: at most two, and only where there are enough bars to
/// make a face. They refer to `mesh`.
std::vector<CageScene> cage_scenes(const scene::Mesh& mesh, const ClosedSurfaces& surfaces,
                                   double shortest_chord_m);

/// Boxes that may be cages around a point, the likely ones first.
class CageBoxes {
 public:
  static constexpr std::size_t kMost = 9;  ///< boxes around a point

  /// Refers to `scene`, which must outlive it.
  explicit CageBoxes(const CageScene& scene);
  [[nodiscard]] std::vector<geometry::Box> around(const geometry::Vec3& center) const;

 private:
  /// The middles of bars that lie in one plane.
  struct Plane {
    double at = 0.0;
    std::size_t bars = 0;
  };
  /// A coordinate below and one above the point, for each axis.
  using Sides = std::array<std::array<std::optional<double>, 2>, 3>;

  [[nodiscard]] std::vector<Plane> planes(int axis) const;
  [[nodiscard]] Sides nearest_planes(const geometry::Vec3& center, double share) const;
  [[nodiscard]] Sides nearest_flats(const geometry::Vec3& center) const;

  const CageScene& scene_;
  std::array<std::vector<Plane>, 3> planes_;
};

}  // namespace camway::correction
