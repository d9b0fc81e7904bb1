// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <string>
#include <utility>

#include "daemon/geometry/types.h"
#include "tests/support/random.h"

namespace camway::geometry {

/// Random triangles that are hard for the kernels.
class RandomTriangles : public testing::Random {
 public:
  using Random::Random;

  Vec3 on_grid(int size) {
    return {static_cast<double>(integer(0, size)), static_cast<double>(integer(0, size)),
            static_cast<double>(integer(0, size))};
  }

  /// Returns a triangle with small integer coordinates, so that coplanar, touching, collinear and
  /// equal vertices are common.
  Triangle grid_triangle(int size) { return {on_grid(size), on_grid(size), on_grid(size)}; }

  /// Returns a triangle of any size and thinness, down to a segment or a point.
  Triangle thin_triangle() {
    const double size = log_uniform(1e-6, 10.0);
    Triangle t = {in_cube(size), in_cube(size), in_cube(size)};
    switch (integer(0, 5)) {
      case 0:
        t[2] = t[0] + uniform(0.0, 1.0) * (t[1] - t[0]) + in_cube(size * log_uniform(1e-17, 1.0));
        break;
      case 1:
        t[1] = t[0] + in_cube(size * log_uniform(1e-17, 1.0));
        break;
      case 2:
        t[2] = t[1];
        break;
      default:
        break;
    }
    return t;
  }

  Vec3 point_on(const Triangle& t) {
    double u = uniform(0.0, 1.0);
    double v = uniform(0.0, 1.0);
    if (integer(0, 2) == 0) v = 0.0;      // on an edge
    if (integer(0, 3) == 0) u = v = 0.0;  // on a vertex
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
  }

  /// Returns two thin triangles that nearly touch or cross a little, sometimes with nearly parallel
  /// edges.
  std::pair<Triangle, Triangle> close_pair() {
    const Triangle a = thin_triangle();
    Triangle b = thin_triangle();
    const double reach = (a[1] - a[0]).norm() + (a[2] - a[0]).norm();
    if (integer(0, 3) == 0) {
      // Almost parallel to an edge of a.
      b[1] = b[0] + uniform(-2.0, 2.0) * (a[1] - a[0]) + in_cube(reach * log_uniform(1e-17, 1e-3));
    }
    const Vec3 shift = point_on(a) - point_on(b) + in_cube(reach * log_uniform(1e-17, 1.0));
    for (Vec3& v : b) v += shift;
    return {a, b};
  }
};

inline std::string to_text(const Triangle& t) {
  std::string text;
  char buffer[96];
  for (const Vec3& v : t) {
    std::snprintf(buffer, sizeof buffer, "(%a %a %a) ", v.x(), v.y(), v.z());
    text += buffer;
  }
  return text;
}

/// Returns the triangle with its vertices in all six orders.
inline std::array<Triangle, 6> vertex_orders(const Triangle& t) {
  return {Triangle{t[0], t[1], t[2]}, Triangle{t[0], t[2], t[1]}, Triangle{t[1], t[0], t[2]},
          Triangle{t[1], t[2], t[0]}, Triangle{t[2], t[0], t[1]}, Triangle{t[2], t[1], t[0]}};
}

inline Triangle moved(const Triangle& t, const Vec3& shift) {
  return {t[0] + shift, t[1] + shift, t[2] + shift};
}

}  // namespace camway::geometry
