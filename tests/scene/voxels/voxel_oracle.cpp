// SPDX-License-Identifier: MIT
#include "tests/scene/voxels/voxel_oracle.h"

#include <algorithm>
#include <cmath>

#include "tests/support/random.h"

namespace camway::scene::oracle {
namespace {

using Point = std::array<Real, 3>;

Point real(const geometry::Vec3& p) { return {p.x(), p.y(), p.z()}; }

Point sub(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Point add_scaled(const Point& a, const Point& b, Real s) {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}

Real dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Returns the part of a convex polygon with sign * coordinate <= sign * bound.
std::vector<Point> clip(const std::vector<Point>& polygon, std::size_t axis, Real sign,
                        Real bound) {
  std::vector<Point> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    const Real da = sign * (a[axis] - bound);
    const Real db = sign * (b[axis] - bound);
    if (da <= 0) kept.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
      Point cut = add_scaled(a, sub(b, a), da / (da - db));
      cut[axis] = bound;
      kept.push_back(cut);
    }
  }
  return kept;
}

Real distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const Point ab = sub(b, a);
  const Real length2 = dot(ab, ab);
  const Real s = length2 > 0 ? std::clamp<Real>(dot(sub(p, a), ab) / length2, 0, 1) : 0;
  const Point d = sub(p, add_scaled(a, ab, s));
  return std::sqrt(dot(d, d));
}

}  // namespace

RealBox voxel_box(const Voxel& voxel, double resolution_m, Real margin_m) {
  RealBox box{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.min[axis] = static_cast<Real>(voxel[axis]) * resolution_m - margin_m;
    box.max[axis] = static_cast<Real>(voxel[axis] + 1) * resolution_m + margin_m;
  }
  return box;
}

bool touches(const geometry::Triangle& triangle, const RealBox& box) {
  std::vector<Point> polygon{real(triangle[0]), real(triangle[1]), real(triangle[2])};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    polygon = clip(polygon, axis, 1, box.max[axis]);
    polygon = clip(polygon, axis, -1, box.min[axis]);
  }
  return !polygon.empty();
}

Real distance_m(const geometry::Vec3& point, const RealBox& box) {
  const Point p = real(point);
  Point gap{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    gap[axis] = std::max({Real{0}, box.min[axis] - p[axis], p[axis] - box.max[axis]});
  }
  return std::sqrt(dot(gap, gap));
}

Real distance_m(const geometry::Vec3& point, const geometry::Triangle& triangle) {
  const Point p = real(point);
  const Point a = real(triangle[0]);
  const Point ab = sub(real(triangle[1]), a);
  const Point ac = sub(real(triangle[2]), a);
  const Real outline = std::min({distance_to_segment(p, a, real(triangle[1])),
                                 distance_to_segment(p, real(triangle[1]), real(triangle[2])),
                                 distance_to_segment(p, real(triangle[2]), a)});
  const Real determinant = dot(ab, ab) * dot(ac, ac) - dot(ab, ac) * dot(ab, ac);
  if (!(determinant > 0)) return outline;
  const Point ap = sub(p, a);
  const Real s = (dot(ap, ab) * dot(ac, ac) - dot(ap, ac) * dot(ab, ac)) / determinant;
  const Real t = (dot(ap, ac) * dot(ab, ab) - dot(ap, ab) * dot(ab, ac)) / determinant;
  if (s < 0 || t < 0 || s + t > 1) return outline;
  const Point d = sub(ap, add_scaled(add_scaled({0, 0, 0}, ab, s), ac, t));
  return std::min(outline, std::sqrt(dot(d, d)));
}

Real ray_entry_m(const geometry::Vec3& origin, const geometry::Vec3& direction,
                 const RealBox& box) {
  const Point o = real(origin);
  Point d = real(direction);
  const Real length = std::sqrt(dot(d, d));
  Real enter = 0;
  Real leave = HUGE_VALL;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0) {
      if (o[axis] < box.min[axis] || o[axis] > box.max[axis]) return -1;
      continue;
    }
    const Real a = (box.min[axis] - o[axis]) / d[axis];
    const Real b = (box.max[axis] - o[axis]) / d[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter * length : -1;
}

Real ball_way_m(const geometry::Vec3& from, const geometry::Vec3& to, Real radius_m,
                const RealBox& box) {
  const Point a = real(from);
  const Point way = sub(real(to), a);
  const auto distance_at = [&](Real share) {
    const Point p = add_scaled(a, way, share);
    Point gap{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      gap[axis] = std::max({Real{0}, box.min[axis] - p[axis], p[axis] - box.max[axis]});
    }
    return std::sqrt(dot(gap, gap));
  };
  Real low = 0;
  Real high = 1;
  for (int i = 0; i < 200; ++i) {
    const Real third = (high - low) / 3;
    if (distance_at(low + third) <= distance_at(high - third)) {
      high -= third;
    } else {
      low += third;
    }
  }
  const Real nearest = high;
  if (distance_at(0) <= radius_m) return 0;
  if (distance_at(nearest) > radius_m && distance_at(1) > radius_m) return -1;
  Real outside = 0;
  Real touching = distance_at(nearest) <= radius_m ? nearest : Real{1};
  for (int i = 0; i < 100; ++i) {
    const Real middle = (outside + touching) / 2;
    (distance_at(middle) <= radius_m ? touching : outside) = middle;
  }
  return touching * std::sqrt(dot(way, way));
}

std::vector<Voxel> voxels_around(const Mesh& mesh, double resolution_m, int margin) {
  geometry::Box bounds;
  for (const geometry::Vec3& vertex : mesh.vertices) bounds.extend(vertex);
  Voxel first{};
  Voxel last{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Eigen::Index i = static_cast<Eigen::Index>(axis);
    first[axis] = static_cast<std::int32_t>(std::floor(bounds.min()[i] / resolution_m)) - margin;
    last[axis] = static_cast<std::int32_t>(std::floor(bounds.max()[i] / resolution_m)) + margin;
  }
  std::vector<Voxel> voxels;
  for (std::int32_t x = first[0]; x <= last[0]; ++x) {
    for (std::int32_t y = first[1]; y <= last[1]; ++y) {
      for (std::int32_t z = first[2]; z <= last[2]; ++z) voxels.push_back({x, y, z});
    }
  }
  return voxels;
}

Mesh random_mesh(testing::Random& random, double resolution_m, int triangles) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Mesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const geometry::Vec3 center = 3.0 * resolution_m * random.direction();
    const double size_m = resolution_m * random.log_uniform(0.01, 10.0);
    const bool flat = unit(random) < 0.2;  // in a plane of one coordinate
    const Eigen::Index flat_axis = static_cast<Eigen::Index>(random() % 3);
    for (int corner = 0; corner < 3; ++corner) {
      geometry::Vec3 vertex = center + size_m * unit(random) * random.direction();
      if (flat) vertex[flat_axis] = center[flat_axis];
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const bool on_face = flat && axis == flat_axis ? size_m > resolution_m : unit(random) < 0.2;
        if (on_face) vertex[axis] = std::round(vertex[axis] / resolution_m) * resolution_m;
      }
      mesh.vertices.push_back(vertex);
    }
    const auto first = static_cast<std::uint32_t>(3 * i);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  mesh.objects.push_back({"random", 0, static_cast<std::uint32_t>(triangles)});
  return mesh;
}

}  // namespace camway::scene::oracle
