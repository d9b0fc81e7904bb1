// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "daemon/geometry/types.h"

namespace camway::geometry {

/// A binary tree of boxes over the triangles of a body, in the body's own frame, whose origin the
/// body turns about. A node with more than `kLeafTriangles` triangles is divided at the median
/// along the longest side of the box of its triangles' centres.
///
/// Immutable. Thread-safe.
class TriangleTree {
 public:
  /// The box of a node reaches from `center - half` to `center + half`. Both are rounded so that it
  /// holds each vertex of the node's triangles.
  struct Node {
    Vec3 center = Vec3::Zero();
    Vec3 half = Vec3::Zero();
    double radius_m = 0.0;  ///< largest distance of a vertex from the origin, rounded up
    std::uint32_t begin = 0;
    std::uint32_t end = 0;  ///< the triangles are `order()[begin]` to `order()[end - 1]`
    /// Number of the second child, or 0 for a leaf. The first child follows its parent.
    std::uint32_t second_child = 0;

    [[nodiscard]] bool is_leaf() const { return second_child == 0; }
  };

  static constexpr std::uint32_t kLeafTriangles = 4;  ///< most triangles of a leaf
  /// Most nodes on the way from the root to a leaf: each division halves the number of triangles.
  static constexpr std::size_t kMaxDepth = 33;

  /// Requires a triangle or more, and fewer than 2^32, with coordinates below kLargestCoordinate_m.
  explicit TriangleTree(std::span<const Triangle> triangles);

  /// The nodes, parents before their children; the first is the root.
  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
  /// The numbers of the triangles, each once, those of a node together.
  [[nodiscard]] std::span<const std::uint32_t> order() const { return order_; }
  [[nodiscard]] std::size_t memory_bytes() const {
    return nodes_.size() * sizeof(Node) + order_.size() * sizeof(std::uint32_t);
  }

 private:
  void build(std::span<const Triangle> triangles, std::span<const Vec3> centers,
             std::uint32_t begin, std::uint32_t end);
  /// Divides the triangles of a node and returns the first one of the second half.
  std::uint32_t divide(std::span<const Vec3> centers, std::uint32_t begin, std::uint32_t end);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

/// Length of `v`, never below the true one; squares neither overflow nor vanish.
double length_above(const Vec3& v);

}  // namespace camway::geometry
