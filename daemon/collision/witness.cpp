// SPDX-License-Identifier: MIT
#include "daemon/collision/witness.h"

#include <algorithm>
#include <array>
#include <limits>

#include "daemon/geometry/triangle_distance.h"
#include "daemon/geometry/triangle_intersection.h"
#include "daemon/scene/index/scene_index.h"

namespace camway::collision {

namespace {

using geometry::Triangle;
using geometry::Vec3;

// Most pairs that are looked at of a body of many triangles, which takes about a millisecond.
constexpr int kMaxPairs = 4096;

// The smaller of the two depths to which `moving` reaches through the plane of `fixed`.
double depth_through_plane_m(const Triangle& moving, const Triangle& fixed) {
  const Vec3 normal = (fixed[1] - fixed[0]).cross(fixed[2] - fixed[0]);
  const double length = normal.norm();
  if (!(length > 0.0)) return std::numeric_limits<double>::infinity();
  double above_m = 0.0;
  double below_m = 0.0;
  for (const Vec3& vertex : moving) {
    const double height_m = normal.dot(vertex - fixed[0]) / length;
    above_m = std::max(above_m, height_m);
    below_m = std::max(below_m, -height_m);
  }
  return std::min(above_m, below_m);
}

double depth_of_crossing_m(const Triangle& part, const Triangle& obstacle) {
  const double depth_m =
      std::min(depth_through_plane_m(part, obstacle), depth_through_plane_m(obstacle, part));
  return std::isfinite(depth_m) ? depth_m : 0.0;
}

Vec3 closest_on_segment(const Vec3& a, const Vec3& b, const Vec3& point) {
  const Vec3 along = b - a;
  const double squared = along.squaredNorm();
  if (!(squared > 0.0)) return a;
  return a + std::clamp(along.dot(point - a) / squared, 0.0, 1.0) * along;
}

Vec3 closest_on_triangle(const Triangle& triangle, const Vec3& point) {
  const Vec3 e = triangle[1] - triangle[0];
  const Vec3 f = triangle[2] - triangle[0];
  const Vec3 normal = e.cross(f);
  const double squared = normal.squaredNorm();
  if (squared > 0.0) {
    const Vec3 offset = point - triangle[0];
    const double v = offset.cross(f).dot(normal) / squared;
    const double w = e.cross(offset).dot(normal) / squared;
    if (v >= 0.0 && w >= 0.0 && v + w <= 1.0) return triangle[0] + v * e + w * f;
  }
  Vec3 closest = closest_on_segment(triangle[0], triangle[1], point);
  for (std::size_t i = 1; i < 3; ++i) {
    const Vec3 other = closest_on_segment(triangle[i], triangle[(i + 1) % 3], point);
    if ((other - point).squaredNorm() < (closest - point).squaredNorm()) closest = other;
  }
  return closest;
}

// The feature of a near quadrilateral that a triangle cuts: a corner if it cuts both edges there,
// one edge, or only the inside. Numbered as in `motion::Body::feature_name`.
std::uint32_t camera_feature(const Probe& probe, const Triangle& obstacle) {
  const std::array<Vec3, 4> corners{probe.vertex_W(0), probe.vertex_W(1), probe.vertex_W(2),
                                    probe.vertex_W(5)};
  std::array<bool, 4> cut{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3& next = corners[(i + 1) % 4];
    cut[i] = geometry::triangles_touch({corners[i], next, next}, obstacle);
  }
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (cut[(i + 3) % 4] && cut[i]) return 5 + i;
  }
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (cut[i]) return 1 + i;
  }
  return 0;
}

// The triangle whose first vertex is deepest inside a solid of the body.
std::optional<Witness> deepest_inside(Probe& probe, const motion::Stretch& stretch) {
  const scene::SceneIndex& index = probe.obstacles().index;
  std::optional<Witness> deepest;
  if (!probe.body().is_solid()) return deepest;
  index.for_each_touching(probe.vertex_box(), [&](std::uint32_t number) {
    const Vec3 point_W = index.triangle(number)[0];
    const std::optional<double> depth_m = probe.depth_in_body_m(stretch, point_W);
    if (!depth_m || (deepest && *depth_m + probe.required_distance_m() <= deepest->depth_m))
      return true;
    deepest = Witness{0.0, number, 0, *depth_m + probe.required_distance_m(), point_W};
    return true;
  });
  return deepest;
}

// The vertex that is farthest beyond the bounds. Requires the body to be placed.
std::optional<Witness> beyond_bounds(const Probe& probe, double beyond_m) {
  const std::optional<VertexAtSide> vertex = probe.least_deep_vertex();
  if (!vertex || vertex->gap_m > beyond_m) return std::nullopt;
  const Vec3 vertex_W = probe.vertex_W(vertex->vertex);
  Witness witness;
  witness.triangle = Obstacles::number_of_side(vertex->side);
  witness.depth_m = std::max(0.0, -vertex->gap_m);
  const Vec3 inward = geometry::Bounds::inward(vertex->side);
  witness.point_W = vertex_W - probe.obstacles().bounds.depth_m(vertex->side, vertex_W) * inward;
  // The corners of (c0, c1, c2) and (c0, c2, c3).
  constexpr std::array<std::uint32_t, 6> kCorners = {0, 1, 2, 0, 2, 3};
  witness.feature = probe.body().is_camera() ? 5 + kCorners[vertex->vertex]
                                             : static_cast<std::uint32_t>(vertex->vertex / 3);
  return witness;
}

// The deepest contact with a triangle, without its point; its feature is the part of the body.
std::optional<Witness> deepest_pair(Probe& probe, double beyond_m) {
  const double keep_m = probe.required_distance_m();
  std::optional<Witness> deepest;
  int left = kMaxPairs;
  probe.for_each_pair(keep_m + beyond_m, [&](std::uint32_t part, const Triangle& placed,
                                             std::uint32_t number, const Triangle& obstacle) {
    const bool goes_on = probe.body().tree() == nullptr || --left > 0;
    const bool touches = geometry::triangles_touch(placed, obstacle);
    if (!touches && !(keep_m + beyond_m > 0.0)) return goes_on;
    const double distance_m = touches ? 0.0 : geometry::triangle_distance(placed, obstacle);
    if (distance_m > keep_m + beyond_m) return goes_on;
    const double crossing_m = touches ? depth_of_crossing_m(placed, obstacle) : 0.0;
    const double depth_m = std::max(0.0, keep_m - distance_m + crossing_m);
    const bool tie = deepest && depth_m == deepest->depth_m && number < deepest->triangle;
    if (!deepest || depth_m > deepest->depth_m || tie)
      deepest = Witness{0.0, number, part, depth_m, Vec3::Zero()};
    return goes_on;
  });
  return deepest;
}

std::optional<Witness> deepest_in_scene(Probe& probe, const motion::Stretch& stretch,
                                        double beyond_m) {
  probe.place(stretch);
  std::optional<Witness> deepest = deepest_pair(probe, beyond_m);
  std::optional<Witness> inside = deepest_inside(probe, stretch);
  if (inside && (!deepest || inside->depth_m > deepest->depth_m)) {
    inside->feature = probe.nearest_part(inside->point_W);
    return inside;
  }
  if (!deepest) return std::nullopt;
  const Triangle obstacle = probe.obstacles().index.triangle(deepest->triangle);
  deepest->point_W = closest_on_triangle(obstacle, probe.vertex_box().center());
  if (probe.body().is_camera()) deepest->feature = camera_feature(probe, obstacle);
  return deepest;
}

}  // namespace

std::optional<Witness> deepest_contact(Probe& probe, const motion::Stretch& stretch,
                                       double beyond_m) {
  const std::optional<Witness> scene = deepest_in_scene(probe, stretch, beyond_m);
  const std::optional<Witness> outside = beyond_bounds(probe, beyond_m);
  return outside && (!scene || outside->depth_m > scene->depth_m) ? outside : scene;
}

}  // namespace camway::collision
