// SPDX-License-Identifier: MIT
#include "daemon/geometry/triangle_tree.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "daemon/geometry/rounding.h"

namespace camway::geometry {
namespace {

/// The middle of a side is rounded by 2 units of its ends, half a side, measured from there, by 2,
/// and the ends of a child's box, which it is computed from, by 2 more.
constexpr double kBoxRounding = 8.0 * kUnitRoundoff;

void set_box(TriangleTree::Node& node, const Box& box) {
  node.center = 0.5 * box.min() + 0.5 * box.max();
  const Vec3 widest = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs());
  node.half = (box.max() - node.center).cwiseMax(node.center - box.min()) + kBoxRounding * widest +
              Vec3::Constant(kSmallestNormal);
}

}  // namespace

TriangleTree::TriangleTree(std::span<const Triangle> triangles) : order_(triangles.size()) {
  assert(!triangles.empty());
  std::iota(order_.begin(), order_.end(), 0U);
  std::vector<Vec3> centers;
  centers.reserve(triangles.size());
  for (const Triangle& t : triangles) centers.emplace_back((t[0] + t[1] + t[2]) / 3.0);
  nodes_.reserve(triangles.size());
  build(triangles, centers, 0, static_cast<std::uint32_t>(triangles.size()));
}

void TriangleTree::build(std::span<const Triangle> triangles, std::span<const Vec3> centers,
                         std::uint32_t begin, std::uint32_t end) {
  const std::size_t number = nodes_.size();
  nodes_.emplace_back();
  nodes_[number].begin = begin;
  nodes_[number].end = end;
  if (end - begin <= kLeafTriangles) {
    Box box;
    double radius_m = 0.0;
    for (std::uint32_t i = begin; i < end; ++i) {
      for (const Vec3& vertex : triangles[order_[i]]) {
        box.extend(vertex);
        radius_m = std::max(radius_m, length_above(vertex));
      }
    }
    set_box(nodes_[number], box);
    nodes_[number].radius_m = radius_m;
    return;
  }
  const std::uint32_t middle = divide(centers, begin, end);
  build(triangles, centers, begin, middle);
  const std::size_t second = nodes_.size();
  nodes_[number].second_child = static_cast<std::uint32_t>(second);
  build(triangles, centers, middle, end);
  const Node& a = nodes_[number + 1];
  const Node& b = nodes_[second];
  set_box(nodes_[number], Box((a.center - a.half).cwiseMin(b.center - b.half),
                              (a.center + a.half).cwiseMax(b.center + b.half)));
  nodes_[number].radius_m = std::max(a.radius_m, b.radius_m);
}

std::uint32_t TriangleTree::divide(std::span<const Vec3> centers, std::uint32_t begin,
                                   std::uint32_t end) {
  Box box;
  for (std::uint32_t i = begin; i < end; ++i) box.extend(centers[order_[i]]);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  const auto first = order_.begin();
  // Equal centres are ordered by number, so that the tree is the same everywhere.
  const auto precedes = [&](std::uint32_t a, std::uint32_t b) {
    const double at_a = centers[a][axis];
    const double at_b = centers[b][axis];
    return at_a < at_b || (at_a == at_b && a < b);
  };
  std::nth_element(first + begin, first + middle, first + end, precedes);
  // `nth_element` leaves the order of each half to the library. That of a leaf shows in answers.
  if (middle - begin <= kLeafTriangles) std::sort(first + begin, first + middle);
  if (end - middle <= kLeafTriangles) std::sort(first + middle, first + end);
  return middle;
}

// Three quotients, three squares, two sums, a root and a product are fewer than 8 roundings in
// sequence.
double length_above(const Vec3& v) {
  const double scale = v.lpNorm<Eigen::Infinity>();
  if (scale == 0.0) return 0.0;
  constexpr double kRounding = 8.0 * kUnitRoundoff;
  return scale * (v / scale).norm() * (1.0 + 2.0 * kRounding) + kSmallestNormal;
}

}  // namespace camway::geometry
