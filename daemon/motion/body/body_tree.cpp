// SPDX-License-Identifier: MIT
#include "daemon/motion/body/body_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "daemon/geometry/rounding.h"

namespace camway::motion {
namespace {

using geometry::Box;
using geometry::Triangle;
using geometry::Vec3;

/// Returns a ball about the triangles, as a node without children.
BodyTree::Node ball_about(std::span<const Triangle> triangles_C, double body_radius_m,
                          std::span<const std::uint32_t> numbers) {
  Box box;
  for (const std::uint32_t number : numbers) box.extend(geometry::bounds(triangles_C[number]));
  BodyTree::Node node;
  node.center_C = box.center();
  // The bounds of motion hold for points as near to the eye as the body. A vertex is such a point.
  if (geometry::length_above(node.center_C) > body_radius_m) {
    node.center_C = triangles_C[numbers.front()][0];
  }
  for (const std::uint32_t number : numbers) {
    for (const Vec3& vertex : triangles_C[number]) {
      node.radius_m = std::max(node.radius_m, geometry::length_above(vertex - node.center_C));
    }
  }
  return node;
}

}  // namespace

BodyTree::BodyTree(std::span<const Triangle> triangles_C, double body_radius_m)
    : order_(triangles_C.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  build(triangles_C, body_radius_m, 0, static_cast<std::uint32_t>(order_.size()));
}

void BodyTree::build(std::span<const Triangle> triangles_C, double body_radius_m,
                     std::uint32_t begin, std::uint32_t end) {
  const std::size_t number = nodes_.size();
  const std::span<std::uint32_t> mine = std::span(order_).subspan(begin, end - begin);
  Node node = ball_about(triangles_C, body_radius_m, mine);
  node.begin = begin;
  node.end = end;
  nodes_.push_back(node);
  if (end - begin <= kLeafTriangles) return;

  const auto middle_of = [&](std::uint32_t triangle) -> Vec3 {
    return triangles_C[triangle][0] + triangles_C[triangle][1] + triangles_C[triangle][2];
  };
  Box middles;
  for (const std::uint32_t triangle : mine) middles.extend(middle_of(triangle));
  Eigen::Index axis = 0;
  middles.sizes().maxCoeff(&axis);
  const std::uint32_t half = begin + (end - begin) / 2;
  std::ranges::nth_element(mine, mine.begin() + (half - begin), {}, [&](std::uint32_t triangle) {
    return std::pair(middle_of(triangle)[axis], triangle);
  });
  build(triangles_C, body_radius_m, begin, half);
  nodes_[number].second_child = static_cast<std::uint32_t>(nodes_.size());
  build(triangles_C, body_radius_m, half, end);
}

}  // namespace camway::motion
