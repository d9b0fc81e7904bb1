// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "daemon/motion/camera.h"

namespace camway::motion {

/// What a body is made of. Everything is given in the camera frame C: the eye is the origin, so a
/// body turns about the eye wherever it is placed.
struct BoxShape {
  geometry::Vec3 center_C = geometry::Vec3::Zero();
  geometry::Vec3 size_m = geometry::Vec3::Zero();  ///< full edge lengths [Limit: 0 < value]
};
struct SphereShape {
  geometry::Vec3 center_C = geometry::Vec3::Zero();
  double radius_m = 0.0;  ///< [Limit: 0 < value]
};
/// The union of the convex hulls of sets of points; a set may be flat, a segment or a point.
struct ConvexShape {
  std::vector<std::vector<geometry::Vec3>> pieces_C;
};
/// A surface: like the scene's, it has no inside.
struct MeshShape {
  std::vector<geometry::Vec3> vertices_C;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};
using BodyShape = std::variant<Camera, BoxShape, SphereShape, ConvexShape, MeshShape>;

/// A half-space `normal · x <= offset`.
struct HalfSpace {
  geometry::Vec3 normal = geometry::Vec3::UnitX();  ///< unit length
  double offset_m = 0.0;
};

/// The convex solid that is the intersection of half-spaces; a scene that lies wholly inside it
/// touches none of the body's triangles and collides all the same.
struct Solid {
  std::vector<HalfSpace> faces_C;
};

/// The rigid body that moves along a path, prepared for collision queries: the points of
/// `triangles_C`, each thickened by a ball of `ball_radius_m`, and the insides of `solids_C`. The
/// filled near quadrilateral of a camera is two triangles, a ball of radius 0 and no solid; a
/// sphere is one triangle that has shrunk to its centre, and a ball. Immutable.
class Body {
 public:
  /// The filled near quadrilateral.
  explicit Body(const Camera& camera);

  /// Any shape. Nothing, and why in `error`, if it is empty, not finite or too large
  /// (`kMaxBodyPoints`, `kMaxBodyTriangles`). Points of a convex piece that rounding leaves outside
  /// of its hull are within `slack_m()`.
  static std::optional<Body> make(const BodyShape& shape, std::string& error);

  [[nodiscard]] std::span<const geometry::Triangle> triangles_C() const { return triangles_C_; }
  [[nodiscard]] double ball_radius_m() const { return ball_radius_m_; }
  [[nodiscard]] std::span<const Solid> solids_C() const { return solids_C_; }
  /// Largest distance of a triangle's vertex from the eye, rounded up: no point of a triangle moves
  /// further under rotation alone than a point at this radius does, and a ball moves as its centre.
  [[nodiscard]] double radius_m() const { return radius_m_; }
  /// What rounding may have left out of the hulls.
  [[nodiscard]] double slack_m() const { return slack_m_; }
  /// Name of a part for a person: "edge 2", "corner 0" or "inside" of a near quadrilateral, "face
  /// 3" of other bodies, "surface" of a sphere.
  [[nodiscard]] std::string feature_name(std::size_t feature) const;

 private:
  Body() = default;

  std::vector<geometry::Triangle> triangles_C_;
  std::vector<Solid> solids_C_;
  double ball_radius_m_ = 0.0;
  double radius_m_ = 0.0;
  double slack_m_ = 0.0;
  bool is_camera_ = false;
};

inline constexpr std::size_t kMaxBodyPoints = 512;      ///< of all pieces, or vertices of a mesh
inline constexpr std::size_t kMaxBodyTriangles = 1024;  ///< of a mesh

}  // namespace camway::motion
