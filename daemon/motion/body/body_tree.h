// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "daemon/geometry/types.h"

namespace camway::motion {

/// Balls about groups of a body's triangles, for bodies of many triangles: most groups are far from
/// the scene, which one query per ball tells. A binary tree, divided at the median of the longest
/// axis.
///
/// Immutable. Thread-safe.
class BodyTree {
 public:
  struct Node {
    geometry::Vec3 center_C = geometry::Vec3::Zero();  ///< no farther from the eye than the body
    double radius_m = 0.0;  ///< of a ball that holds the triangles of the node, rounded up
    std::uint32_t begin = 0;
    std::uint32_t end = 0;  ///< the triangles are `order()[begin]` to `order()[end - 1]`
    /// Number of the second child, or 0 for a leaf. The first child follows its parent.
    std::uint32_t second_child = 0;

    [[nodiscard]] bool is_leaf() const { return second_child == 0; }
  };

  static constexpr std::uint32_t kLeafTriangles = 8;  ///< most triangles of a leaf

  /// Requires at least one triangle, and at most 2³¹. `body_radius_m`: an upper bound of the
  /// distance of their vertices from the eye.
  BodyTree(std::span<const geometry::Triangle> triangles_C, double body_radius_m);

  /// The nodes, parents before their children; the first is the root.
  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
  /// The numbers of the triangles, each once, those of a node together.
  [[nodiscard]] std::span<const std::uint32_t> order() const { return order_; }

 private:
  void build(std::span<const geometry::Triangle> triangles_C, double body_radius_m,
             std::uint32_t begin, std::uint32_t end);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace camway::motion
