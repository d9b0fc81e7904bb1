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

#include "daemon/base/result.h"
#include "daemon/geometry/half_space.h"
#include "daemon/geometry/triangle_tree.h"
#include "daemon/motion/body/camera.h"

namespace camway::motion {

/// Shapes of a body, in the camera frame C. The eye is the origin, so a body turns about the eye
/// wherever it is placed.
struct BoxShape {
  geometry::Vec3 center_C = geometry::Vec3::Zero();
  geometry::Vec3 size_m = geometry::Vec3::Zero();  ///< full edge lengths [Limit: 0 < value]
};
struct SphereShape {
  geometry::Vec3 center_C = geometry::Vec3::Zero();
  double radius_m = 0.0;  ///< [Limit: 0 < value]
};
/// The union of the convex hulls of sets of points. A set may be flat, a segment or a point, but
/// the body is not a single point.
struct ConvexShape {
  std::vector<std::vector<geometry::Vec3>> pieces_C;
};
/// A surface. Like the scene's, it has no inside, unless it is declared solid. It is not a single
/// point.
struct MeshShape {
  std::vector<geometry::Vec3> vertices_C;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Whether the inside belongs to the body: all points that the surface goes round
  /// (`geometry::winding_number`). Then the surface must be closed (`fault_of_surface`).
  bool solid = false;
};
using BodyShape = std::variant<Camera, BoxShape, SphereShape, ConvexShape, MeshShape>;

/// A convex solid, the intersection of half-spaces. A part of the scene wholly inside it touches
/// none of the body's triangles and collides all the same.
struct Solid {
  std::vector<geometry::HalfSpace> faces_C;

  /// Whether a point is inside, as computed.
  [[nodiscard]] bool holds(const geometry::Vec3& point_C) const;
};

/// Limits of shapes.
inline constexpr std::size_t kMaxBodyPoints = 512;        ///< points of all convex pieces
inline constexpr std::size_t kMaxBodyVertices = 100000;   ///< vertices of a mesh
inline constexpr std::size_t kMaxBodyTriangles = 100000;  ///< triangles of a mesh
inline constexpr double kMaxBodyCoordinate_m = 1e9;       ///< any coordinate, size or radius

/// A fault of a shape.
struct ShapeFault {
  std::string field;   ///< field below the shape, e.g. "size[1]"; empty for the whole shape
  std::string reason;  ///< e.g. "is -1 m; it must be above 0 and at most 1e+09"
};

/// Checks sizes, counts and finiteness. Returns nothing if `Body::make` accepts the shape.
/// Thread-safe.
std::optional<ShapeFault> fault_in(const BodyShape& shape);

/// The rigid body that moves along a path, prepared for collision queries: the points of
/// `triangles_C`, each thickened by a ball of `ball_radius_m`, and the insides of `solids_C`.
/// - A camera is the two triangles of its filled near quadrilateral, with a ball of radius 0.
/// - A sphere is one triangle, shrunk to its centre, and a ball.
/// - A box or a convex piece with volume is the triangles of its surface and a solid.
/// - A flat convex piece or a mesh is triangles alone.
/// - The inside of a solid mesh belongs to the body, too.
///
/// A body of many triangles has a tree over them.
///
/// Immutable. Thread-safe.
class Body {
 public:
  /// The filled near quadrilateral: corners c0..c3 of `near_corners_C` as the triangles (c0, c1,
  /// c2) and (c0, c2, c3).
  explicit Body(const Camera& camera);
  /// The filled near quadrilateral with these corners.
  explicit Body(const Corners& corners_C);

  /// Returns a body of any shape. Fails exactly if `fault_in` returns a fault.
  static base::Result<Body> make(const BodyShape& shape);

  /// Whether a point is inside the body or within `distance_m` of it, as computed.
  [[nodiscard]] bool is_near(const geometry::Vec3& point_C, double distance_m) const;

  /// Returns the body scaled about a point by a factor; for searches, since it bounds no rounding.
  /// [Limit: 0 < factor <= 1]
  [[nodiscard]] Body scaled(const geometry::Vec3& center_C, double factor) const;

  /// Triangles of solids are counter-clockwise seen from outside, those of a mesh as given.
  [[nodiscard]] std::span<const geometry::Triangle> triangles_C() const { return triangles_C_; }
  /// A point of the body: the centroid of its first triangle, as computed.
  [[nodiscard]] geometry::Vec3 point_C() const {
    const geometry::Triangle& part = triangles_C_.front();
    return (part[0] + part[1] + part[2]) / 3.0;
  }
  [[nodiscard]] double ball_radius_m() const { return ball_radius_m_; }
  [[nodiscard]] std::span<const Solid> solids_C() const { return solids_C_; }
  /// Largest distance of a triangle's vertex from the eye, rounded up. Under rotation alone no
  /// point of a triangle moves farther than a point at this radius, and a ball moves as its centre.
  [[nodiscard]] double radius_m() const { return radius_m_; }
  /// Bound of the rounding of the shape: every point of the shape as given is within this of the
  /// triangles (and their balls) or inside a solid. It comes from rounding the corners of a camera
  /// or a box; 0 for shapes given by their points, as hulls are exact (`convex_hull.h`).
  [[nodiscard]] double slack_m() const { return slack_m_; }
  [[nodiscard]] bool is_camera() const { return is_camera_; }

  /// The tree over the triangles; null for a body of few triangles, which queries look at one by
  /// one.
  [[nodiscard]] const geometry::TriangleTree* tree() const { return tree_ ? &*tree_ : nullptr; }
  /// Whether the triangles are the surface of a solid. If so, there is a tree.
  [[nodiscard]] bool is_solid_mesh() const { return is_solid_mesh_; }
  /// Whether the body has an inside: solids, or a solid mesh.
  [[nodiscard]] bool is_solid() const { return is_solid_mesh_ || !solids_C_.empty(); }
  /// Numbers of triangles, at least one of each connected part of the surface.
  [[nodiscard]] std::span<const std::uint32_t> connected_parts() const { return parts_; }
  /// The smallest box that holds the triangles.
  [[nodiscard]] const geometry::Box& box_C() const { return box_C_; }
  /// Middle of that box, and the largest distance of a vertex from it, as computed.
  [[nodiscard]] const geometry::Vec3& center_C() const { return center_C_; }
  [[nodiscard]] double center_radius_m() const { return center_radius_m_; }
  /// Longest edge of a triangle, rounded up. [Units: metres]
  [[nodiscard]] double longest_edge_m() const { return longest_edge_m_; }
  /// Memory that the body takes beside this object.
  [[nodiscard]] std::size_t memory_bytes() const;

  /// Name of a feature for users: of a near quadrilateral "inside" (0), "edge 0" to "edge 3" (1 to
  /// 4; edge i joins corners i and i + 1) and "corner 0" to "corner 3" (5 to 8); "surface" of a
  /// sphere; of other bodies "face k" for triangle k.
  [[nodiscard]] std::string feature_name(std::size_t feature) const;

 private:
  Body() = default;
  void add(const BoxShape& box);
  void add(const SphereShape& sphere);
  void add(const ConvexShape& convex);
  void add(const MeshShape& mesh);
  /// Measures the triangles, and makes the tree. Requires that all have been added.
  void prepare();

  std::vector<geometry::Triangle> triangles_C_;
  std::vector<Solid> solids_C_;
  std::optional<geometry::TriangleTree> tree_;
  std::vector<std::uint32_t> parts_;
  geometry::Box box_C_;
  geometry::Vec3 center_C_ = geometry::Vec3::Zero();
  double center_radius_m_ = 0.0;
  double longest_edge_m_ = 0.0;
  double ball_radius_m_ = 0.0;
  double radius_m_ = 0.0;
  double slack_m_ = 0.0;
  bool is_camera_ = false;
  bool is_solid_mesh_ = false;
};

}  // namespace camway::motion
