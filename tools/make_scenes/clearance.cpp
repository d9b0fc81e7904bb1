// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "tools/make_scenes/request.h"

namespace camway::make_scenes {
namespace {

using Vec = std::array<double, 3>;
using Face = std::array<Vec, 3>;

Vec minus(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec plus_scaled(const Vec& a, const Vec& b, double s) {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}
double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Vec& a) { return std::sqrt(dot(a, a)); }

double point_segment(const Vec& p, const Vec& a, const Vec& b) {
  const Vec ab = minus(b, a);
  const double l2 = dot(ab, ab);
  const double s = l2 > 0.0 ? std::clamp(dot(minus(p, a), ab) / l2, 0.0, 1.0) : 0.0;
  return length(minus(p, plus_scaled(a, ab, s)));
}

/// Returns whether the point of the face's plane nearest to `p` lies in the face.
bool above_face(const Vec& p, const Face& f, const Vec& normal) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec edge = minus(f[(i + 1) % 3], f[i]);
    if (dot(cross(edge, minus(p, f[i])), normal) < 0.0) return false;
  }
  return true;
}

double point_face(const Vec& p, const Face& f) {
  double best = std::min(
      {point_segment(p, f[0], f[1]), point_segment(p, f[1], f[2]), point_segment(p, f[2], f[0])});
  const Vec normal = cross(minus(f[1], f[0]), minus(f[2], f[0]));
  const double size = length(normal);
  if (size > 0.0 && above_face(p, f, normal)) {
    best = std::min(best, std::abs(dot(minus(p, f[0]), normal)) / size);
  }
  return best;
}

double segment_segment(const Vec& a, const Vec& b, const Vec& c, const Vec& d) {
  double best = std::min({point_segment(a, c, d), point_segment(b, c, d), point_segment(c, a, b),
                          point_segment(d, a, b)});
  const Vec u = minus(b, a);
  const Vec v = minus(d, c);
  const Vec w = minus(c, a);
  const Vec n = cross(u, v);
  const double n2 = dot(n, n);
  if (n2 > 0.0) {
    const double s = dot(cross(w, v), n) / n2;
    const double t = dot(cross(w, u), n) / n2;
    if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) {
      best = std::min(best, std::abs(dot(w, n)) / std::sqrt(n2));
    }
  }
  return best;
}

bool crosses(const Vec& a, const Vec& b, const Face& f) {
  const Vec normal = cross(minus(f[1], f[0]), minus(f[2], f[0]));
  const double da = dot(minus(a, f[0]), normal);
  const double db = dot(minus(b, f[0]), normal);
  if (da * db > 0.0 || da == db) return false;
  return above_face(plus_scaled(a, minus(b, a), da / (da - db)), f, normal);
}

double face_face(const Face& f, const Face& g) {
  double best = HUGE_VAL;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec& a = f[i];
    const Vec& b = f[(i + 1) % 3];
    const Vec& c = g[i];
    const Vec& d = g[(i + 1) % 3];
    if (crosses(a, b, g) || crosses(c, d, f)) return 0.0;
    best = std::min({best, point_face(a, g), point_face(c, f)});
    for (std::size_t k = 0; k < 3; ++k) {
      best = std::min(best, segment_segment(a, b, g[k], g[(k + 1) % 3]));
    }
  }
  return best;
}

std::array<Vec, 4> near_quadrilateral(const Lens& lens, const View& view) {
  constexpr double kHalfDegree = 3.14159265358979323846 / 360.0;
  const double n = static_cast<double>(lens.near) / 1e6;
  const double x = n * std::tan(lens.fov_x_deg * kHalfDegree);
  const double y = n * std::tan(lens.fov_y_deg * kHalfDegree);
  const Quaternion& q = view.orientation;
  const Vec axis{q[1], q[2], q[3]};
  std::array<Vec, 4> corners{{{x, y, -n}, {-x, y, -n}, {-x, -y, -n}, {x, -y, -n}}};
  for (Vec& c : corners) {
    const Vec t = cross(axis, c);  // v + 2w(a x v) + 2a x (a x v)
    c = plus_scaled(plus_scaled(c, t, 2.0 * q[0]), cross(axis, t), 2.0);
    for (std::size_t i = 0; i < 3; ++i) c[i] += static_cast<double>(view.eye[i]) / 1e6;
  }
  return corners;
}

/// Returns whether the bounding boxes of the two are further apart than `distance` along some axis.
template <typename A, typename B>
bool far_apart(const A& a, const B& b, double distance) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto less = [axis](const Vec& p, const Vec& q) { return p[axis] < q[axis]; };
    const auto [a0, a1] = std::minmax_element(a.begin(), a.end(), less);
    const auto [b0, b1] = std::minmax_element(b.begin(), b.end(), less);
    if ((*a0)[axis] - (*b1)[axis] > distance || (*b0)[axis] - (*a1)[axis] > distance) return true;
  }
  return false;
}

}  // namespace

double clearance_m(const std::vector<Triangle>& triangles, const Lens& lens, const View& view,
                   double cutoff_m) {
  const std::array<Vec, 4> quad = near_quadrilateral(lens, view);
  double best = cutoff_m;
  for (const Triangle& triangle : triangles) {
    Face face{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) face[i][k] = static_cast<double>(triangle[i][k]) / 1e6;
    }
    if (far_apart(quad, face, best)) continue;
    best = std::min({best, face_face({quad[0], quad[1], quad[2]}, face),
                     face_face({quad[0], quad[2], quad[3]}, face)});
  }
  return best;
}

}  // namespace camway::make_scenes
