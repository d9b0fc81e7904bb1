// SPDX-License-Identifier: MIT
#include "daemon/motion/body/body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "daemon/geometry/convex_hull.h"
#include "daemon/geometry/exact_points.h"
#include "daemon/geometry/rounding.h"
#include "daemon/geometry/triangle_distance.h"
#include "daemon/geometry/winding.h"
#include "daemon/motion/body/closed_mesh.h"

namespace camway::motion {
namespace {

using geometry::kUnitRoundoff;
using geometry::Triangle;
using geometry::Vec3;

static_assert(kMaxBodyCoordinate_m <= geometry::kLargestHullCoordinate_m);

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Tangent (2 units: the library's is within 1 ulp), product, and a third for second order; from
/// coordinates to length this bound of each is one of the whole.
constexpr double kCameraCornerRounding = 4.0 * kUnitRoundoff;

/// One addition (halving a size is exact, or loses less than the smallest normal number).
constexpr double kBoxCornerRounding = 2.0 * kUnitRoundoff;

/// Most triangles of a body without a tree: a box, which has 12, is faster without.
constexpr std::size_t kMostWithoutTree = 16;

/// The corner of the box on the upper side of the axes whose bits are set.
Vec3 box_corner(const BoxShape& box, unsigned bits) {
  Vec3 corner;
  for (unsigned k = 0; k < 3; ++k) {
    const Eigen::Index axis = static_cast<Eigen::Index>(k);
    const double half = 0.5 * box.size_m[axis];
    corner[axis] = box.center_C[axis] + ((bits >> k & 1U) != 0U ? half : -half);
  }
  return corner;
}

}  // namespace

Body::Body(const Corners& c)
    : triangles_C_{{c[0], c[1], c[2]}, {c[0], c[2], c[3]}}, is_camera_(true) {
  prepare();
}

Body::Body(const Camera& camera) : Body(near_corners_C(camera)) {
  slack_m_ = kCameraCornerRounding * radius_m_;
}

bool Solid::holds(const Vec3& point_C) const {
  return std::ranges::all_of(faces_C, [&](const geometry::HalfSpace& face) {
    return face.normal.dot(point_C) <= face.offset_m;
  });
}

base::Result<Body> Body::make(const BodyShape& shape) {
  if (const std::optional<ShapeFault> fault = fault_in(shape)) {
    return base::Failure{fault->field.empty() ? fault->reason
                                              : fault->field + ": " + fault->reason};
  }
  if (const Camera* camera = std::get_if<Camera>(&shape)) return Body(*camera);
  Body body;
  std::visit(
      [&]<class Shape>(const Shape& part) {
        if constexpr (!std::is_same_v<Shape, Camera>) body.add(part);
      },
      shape);
  body.prepare();
  if (std::holds_alternative<BoxShape>(shape))
    body.slack_m_ = kBoxCornerRounding * body.radius_m_ + geometry::kSmallestNormal;
  return body;
}

bool Body::is_near(const Vec3& point_C, double distance_m) const {
  const bool is_inside =
      std::ranges::any_of(solids_C_, [&](const Solid& solid) { return solid.holds(point_C); });
  const Triangle point = {point_C, point_C, point_C};
  // A point on the surface has no winding number, and is at no distance.
  if (is_solid_mesh_ && geometry::winding_number(point_C, triangles_C_, *tree_).value_or(0) != 0) {
    return true;
  }
  return is_inside || std::ranges::any_of(triangles_C_, [&](const Triangle& triangle) {
           return geometry::triangle_distance(point, triangle) <= distance_m + ball_radius_m_;
         });
}

Body Body::scaled(const Vec3& center_C, double factor) const {
  Body body;
  body.triangles_C_ = triangles_C_;
  for (Triangle& triangle : body.triangles_C_) {
    for (Vec3& vertex : triangle) vertex = center_C + factor * (vertex - center_C);
  }
  body.solids_C_ = solids_C_;
  for (Solid& solid : body.solids_C_) {
    for (geometry::HalfSpace& face : solid.faces_C) {
      face.offset_m = factor * face.offset_m + (1.0 - factor) * face.normal.dot(center_C);
    }
  }
  body.parts_ = parts_;
  body.ball_radius_m_ = factor * ball_radius_m_;
  body.slack_m_ = slack_m_;
  body.is_solid_mesh_ = is_solid_mesh_;
  body.prepare();
  return body;
}

std::string Body::feature_name(std::size_t feature) const {
  if (ball_radius_m_ > 0.0) return "surface";
  if (!is_camera_) return "face " + std::to_string(feature);
  if (feature == 0) return "inside";
  return feature <= 4 ? "edge " + std::to_string(feature - 1)
                      : "corner " + std::to_string(feature - 5);
}

void Body::add(const BoxShape& box) {
  for (unsigned axis = 0; axis < 3; ++axis) {
    // Where `axis`, `next` and `last` are x, y and z or turned, a right-handed frame: the upper
    // face runs 0, next, next + last, last counter-clockwise, the lower one the other way.
    const unsigned next = 1U << (axis + 1) % 3;
    const unsigned last = 1U << (axis + 2) % 3;
    const unsigned upper = 1U << axis;
    const auto corner = [&](unsigned bits) { return box_corner(box, bits); };
    triangles_C_.push_back({corner(0), corner(next + last), corner(next)});
    triangles_C_.push_back({corner(0), corner(last), corner(next + last)});
    triangles_C_.push_back({corner(upper), corner(upper + next), corner(upper + next + last)});
    triangles_C_.push_back({corner(upper), corner(upper + next + last), corner(upper + last)});
  }
  Solid solid;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Vec3 normal = Vec3::Unit(axis);
    solid.faces_C.push_back({-normal, std::nextafter(-box_corner(box, 0)[axis], kInfinity)});
    solid.faces_C.push_back({normal, std::nextafter(box_corner(box, 7)[axis], kInfinity)});
  }
  solids_C_.push_back(std::move(solid));
}

void Body::add(const SphereShape& sphere) {
  triangles_C_.push_back({sphere.center_C, sphere.center_C, sphere.center_C});
  ball_radius_m_ = sphere.radius_m;
}

void Body::add(const ConvexShape& convex) {
  for (const std::vector<Vec3>& points : convex.pieces_C) {
    geometry::ConvexHull hull = geometry::convex_hull(points);
    for (const std::array<std::uint32_t, 3>& t : hull.triangles)
      triangles_C_.push_back({points[t[0]], points[t[1]], points[t[2]]});
    if (!hull.faces.empty()) solids_C_.push_back({std::move(hull.faces)});
  }
}

void Body::add(const MeshShape& mesh) {
  for (const std::array<std::uint32_t, 3>& t : mesh.triangles)
    triangles_C_.push_back({mesh.vertices_C[t[0]], mesh.vertices_C[t[1]], mesh.vertices_C[t[2]]});
  if (triangles_C_.size() > kMostWithoutTree) parts_ = motion::connected_parts(mesh);
  is_solid_mesh_ = mesh.solid;
}

void Body::prepare() {
  for (const Triangle& triangle : triangles_C_) box_C_.extend(geometry::bounds(triangle));
  center_C_ = box_C_.center();
  for (const Triangle& triangle : triangles_C_) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& vertex = triangle[k];
      longest_edge_m_ =
          std::max(longest_edge_m_, geometry::length_above(triangle[(k + 1) % 3] - vertex));
      radius_m_ = std::max(radius_m_, geometry::length_above(vertex));
      center_radius_m_ = std::max(center_radius_m_, (vertex - center_C_).norm());
    }
  }
  if (parts_.empty()) {
    parts_.resize(triangles_C_.size());
    std::iota(parts_.begin(), parts_.end(), 0U);
  }
  if (triangles_C_.size() > kMostWithoutTree || is_solid_mesh_) tree_.emplace(triangles_C_);
}

std::size_t Body::memory_bytes() const {
  std::size_t bytes = triangles_C_.size() * sizeof(Triangle) +
                      parts_.size() * sizeof(std::uint32_t) + solids_C_.size() * sizeof(Solid);
  for (const Solid& solid : solids_C_) {
    bytes += solid.faces_C.size() * sizeof(geometry::HalfSpace);
  }
  return bytes + (tree_ ? tree_->memory_bytes() : 0);
}

}  // namespace camway::motion
