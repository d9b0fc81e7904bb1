// SPDX-License-Identifier: MIT
#include "daemon/geometry/triangle_box.h"

#include <algorithm>
#include <cmath>

#include "daemon/geometry/rounding.h"

namespace camway::geometry {
namespace {

bool boxes_apart(const Triangle& t, const Box& box) {
  for (int k = 0; k < 3; ++k) {
    if (std::min({t[0][k], t[1][k], t[2][k]}) > box.max()[k] ||
        std::max({t[0][k], t[1][k], t[2][k]}) < box.min()[k]) {
      return true;
    }
  }
  return false;
}

struct LocalBox {
  Triangle triangle;  ///< relative to the middle of the box
  Vec3 half_extents;  ///< at least the true ones, up to their rounding
  double scale;
};

bool axis_separates(const LocalBox& local, const Vec3& axis) {
  const double p0 = axis.dot(local.triangle[0]);
  const double p1 = axis.dot(local.triangle[1]);
  const double p2 = axis.dot(local.triangle[2]);
  const double radius = axis.cwiseAbs().dot(local.half_extents);
  const double gap = std::max(std::min({p0, p1, p2}), -std::max({p0, p1, p2})) - radius;
  return gap > triangle_box_gap_error(axis, local.scale);
}

}  // namespace

// The projection of a vertex has an error of 4u·|axis|_1·scale (translation, product, two sums),
// that of the box as much, their difference 2u: 10u to first order, as in `any_separates` of
// triangle_intersection.cpp.
double triangle_box_gap_error(const Vec3& axis, double scale_m) {
  return 16.0 * kUnitRoundoff * axis.lpNorm<1>() * scale_m + kSmallestNormal;
}

bool triangle_touches_box(const Triangle& triangle, const Box& box) {
  if (box.isEmpty() || boxes_apart(triangle, box)) return false;
  // The middle may be rounded, so the half extent is the larger of the two distances from it.
  const Vec3 middle = 0.5 * box.min() + 0.5 * box.max();
  LocalBox local;
  local.half_extents = (box.max() - middle).cwiseMax(middle - box.min());
  local.scale = local.half_extents.maxCoeff();
  for (std::size_t i = 0; i < 3; ++i) {
    local.triangle[i] = triangle[i] - middle;
    local.scale = std::max(local.scale, local.triangle[i].lpNorm<Eigen::Infinity>());
  }
  // Beyond this, products of three coordinates could overflow, and then nothing is proved.
  if (!(local.scale < 0x1p300)) return true;
  const std::array<Vec3, 3> edges = {local.triangle[1] - local.triangle[0],
                                     local.triangle[2] - local.triangle[1],
                                     local.triangle[0] - local.triangle[2]};
  if (axis_separates(local, edges[0].cross(edges[1]))) return false;
  for (const Vec3& e : edges) {
    if (axis_separates(local, {0.0, -e.z(), e.y()}) ||
        axis_separates(local, {e.z(), 0.0, -e.x()}) ||
        axis_separates(local, {-e.y(), e.x(), 0.0})) {
      return false;
    }
  }
  return true;
}

double squared_box_distance_m2(const Box& a, const Box& b) {
  double squared = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double gap = std::max({0.0, a.min()[k] - b.max()[k], b.min()[k] - a.max()[k]});
    squared += gap * gap;
  }
  return squared;
}

}  // namespace camway::geometry
