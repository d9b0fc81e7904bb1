// SPDX-License-Identifier: MIT
#include "daemon/scene/import/surfaces/quadrics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>

namespace camway::scene::surfaces {
namespace {

using Corners = std::array<std::uint32_t, 3>;

/// Points are computed in doubles, from sines and roots that are off by a few roundoffs.
constexpr double kComputed = 1e-14;

/// Edges of an icosahedron are divided into so many. 18 is the least with which the facets of a
/// unit sphere are within `kRelativeTolerance`.
constexpr std::uint32_t kFrequency = 18;

/// 72 sides: 1 - cos(pi / 72) = 0.95e-3.
constexpr std::uint32_t kSides = 72;
static_assert(kSides >= 72 && kRelativeTolerance >= 1e-3, "the constants belong together");

Point difference(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// The corners of an icosahedron, and its faces counter-clockwise from outside.
std::array<Point, 12> icosahedron_corners() {
  constexpr double kPhi = std::numbers::phi;
  return {{{-1, kPhi, 0},
           {1, kPhi, 0},
           {-1, -kPhi, 0},
           {1, -kPhi, 0},
           {0, -1, kPhi},
           {0, 1, kPhi},
           {0, -1, -kPhi},
           {0, 1, -kPhi},
           {kPhi, 0, -1},
           {kPhi, 0, 1},
           {-kPhi, 0, -1},
           {-kPhi, 0, 1}}};
}
constexpr std::array<Corners, 20> kIcosahedronFaces = {
    {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};

/// The unit sphere, built once.
class UnitSphere {
 public:
  UnitSphere() {
    for (const Corners& face : kIcosahedronFaces) add_face(face);
    for (const Corners& facet : sphere_.triangles) {
      sphere_.error = std::max(sphere_.error, sagitta(facet));
    }
    sphere_.error += kComputed;
  }
  [[nodiscard]] const FacetedSurface& surface() const { return sphere_; }

 private:
  /// A point is known by the parts of the corners in it, so that faces share those of their edges.
  using Key = std::array<std::array<std::uint32_t, 2>, 3>;

  void add_face(const Corners& face) {
    for (std::uint32_t i = 0; i < kFrequency; ++i) {
      for (std::uint32_t j = 0; i + j < kFrequency; ++j) {
        const std::uint32_t a = point(face, i, j);
        const std::uint32_t b = point(face, i + 1, j);
        const std::uint32_t c = point(face, i, j + 1);
        sphere_.triangles.push_back({a, b, c});
        if (i + j + 1 < kFrequency) {
          sphere_.triangles.push_back({b, point(face, i + 1, j + 1), c});
        }
      }
    }
  }

  std::uint32_t point(const Corners& face, std::uint32_t i, std::uint32_t j) {
    Key key = {{{face[0], kFrequency - i - j}, {face[1], i}, {face[2], j}}};
    for (auto& part : key) {
      if (part[1] == 0) part = {};  // whichever corner it is that does not count
    }
    std::sort(key.begin(), key.end());
    const auto [found, is_new] =
        index_.try_emplace(key, static_cast<std::uint32_t>(sphere_.points.size()));
    if (is_new) sphere_.points.push_back(on_sphere(key));
    return found->second;
  }

  [[nodiscard]] Point on_sphere(const Key& key) const {
    Point sum{};
    for (const auto& [corner, weight] : key) {
      for (std::size_t k = 0; k < 3; ++k) sum[k] += weight * corners_[corner][k];
    }
    const double length = std::sqrt(dot(sum, sum));
    for (double& x : sum) x /= length;
    return sum;
  }

  /// How far the facet is inside the sphere: least distance of its plane from the centre.
  [[nodiscard]] double sagitta(const Corners& facet) const {
    const Point& a = sphere_.points[facet[0]];
    const Point normal =
        cross(difference(sphere_.points[facet[1]], a), difference(sphere_.points[facet[2]], a));
    return 1.0 - std::abs(dot(normal, a)) / std::sqrt(dot(normal, normal));
  }

  const std::array<Point, 12> corners_ = icosahedron_corners();
  std::map<Key, std::uint32_t> index_;
  FacetedSurface sphere_;
};

/// Points on a circle around the y axis, counter-clockwise as seen from +y.
void add_circle(FacetedSurface& surface, double radius, double y) {
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kSides;
    surface.points.push_back({radius * std::sin(angle), y, radius * std::cos(angle)});
  }
}

void add_cap(FacetedSurface& surface, std::uint32_t first, bool up) {
  for (std::uint32_t i = 1; i + 1 < kSides; ++i) {
    const std::uint32_t b = first + i;
    const std::uint32_t c = first + i + 1;
    surface.triangles.push_back(up ? Corners{first, b, c} : Corners{first, c, b});
  }
}

/// The facets of `kSides` sides are inside the circle by this at most.
double circle_error(double radius) {
  return std::abs(radius) * (1.0 - std::cos(std::numbers::pi / kSides) + kComputed);
}

}  // namespace

FacetedSurface sphere(double radius) {
  static const UnitSphere kUnit;
  FacetedSurface result = kUnit.surface();
  for (Point& point : result.points) {
    for (double& x : point) x *= radius;
  }
  result.error *= std::abs(radius);
  return result;
}

FacetedSurface cylinder(double radius, double height, const CylinderParts& parts) {
  FacetedSurface result;
  add_circle(result, radius, -0.5 * height);
  add_circle(result, radius, 0.5 * height);
  for (std::uint32_t i = 0; parts.side && i < kSides; ++i) {
    const std::uint32_t next = (i + 1) % kSides;
    result.triangles.push_back({i, next, kSides + next});
    result.triangles.push_back({i, kSides + next, kSides + i});
  }
  if (parts.top) add_cap(result, kSides, true);
  if (parts.bottom) add_cap(result, 0, false);
  result.error = circle_error(radius);
  return result;
}

FacetedSurface cone(double bottom_radius, double height, const CylinderParts& parts) {
  FacetedSurface result;
  add_circle(result, bottom_radius, -0.5 * height);
  result.points.push_back({0.0, 0.5 * height, 0.0});
  for (std::uint32_t i = 0; parts.side && i < kSides; ++i) {
    result.triangles.push_back({i, (i + 1) % kSides, kSides});
  }
  if (parts.bottom) add_cap(result, 0, false);
  result.error = circle_error(bottom_radius);
  return result;
}

}  // namespace camway::scene::surfaces
