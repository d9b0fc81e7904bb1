// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "daemon/scene/index/scene_index.h"

namespace camway::bench {

/// Limits of a BSP tree for any input.
struct BspOptions {
  std::uint32_t threshold = 16;  ///< most pieces of a leaf that is not split [Limit: value >= 1]
  std::uint32_t max_depth = 48;  ///< most levels below the root [Limit: value <= kMaxBspDepth]
  double max_duplication = 8.0;  ///< most pieces per triangle of the mesh [Limit: value >= 1]
};

inline constexpr std::uint32_t kMaxBspDepth = 64;

/// The numbers of nodes and triangles that a query visited.
struct QueryCost {
  std::uint64_t nodes = 0;      ///< inner nodes and leaves
  std::uint64_t triangles = 0;  ///< entries of the leaves, duplicates included
};

/// A plane; `normal` has length 1 but for rounding.
struct BspPlane {
  [[nodiscard]] double height_m(const geometry::Vec3& point) const {
    return normal.dot(point) - offset_m;
  }

  geometry::Vec3 normal = geometry::Vec3::Zero();
  double offset_m = 0.0;
};

/// Binary space partition of a mesh (Fuchs, Kedem & Naylor 1980, "On visible surface generation by
/// a priori tree structures"): each node has a plane and the triangles that lie in it; the pieces
/// of the others go to the side that they are on. Deviations: a leaf holds several pieces; a plane
/// is that of the best of a few triangles; where each of their planes leaves nearly all on one
/// side, as on a convex surface, the middle plane across the longest side is used.
///
/// It answers as `scene::SceneIndex` does, bit for bit: as a loop over all triangles. A node's
/// bound is the largest distance of the body from the planes above it, less `margin_m`.
///
/// Immutable. Thread-safe.
class BspTree {
 public:
  /// Requires a mesh, not null, with coordinates below geometry::kLargestCoordinate_m.
  explicit BspTree(std::shared_ptr<const scene::Mesh> mesh, const BspOptions& options = {});

  /// As `scene::SceneIndex::nearest`, for a body of finite coordinates.
  [[nodiscard]] std::optional<scene::Nearest> nearest(std::span<const geometry::Triangle> body,
                                                      double cutoff_m) const;
  /// As `scene::SceneIndex::any_within`, for a body of finite coordinates. Adds to `cost`, unless
  /// it is null, what the query looked at.
  [[nodiscard]] std::optional<scene::Nearest> any_within(std::span<const geometry::Triangle> body,
                                                         double distance_m,
                                                         QueryCost* cost = nullptr) const;
  /// Whether the body touches any triangle of the mesh. Requires finite coordinates.
  [[nodiscard]] bool touches(std::span<const geometry::Triangle> body) const;

  [[nodiscard]] std::size_t nodes() const { return nodes_.size(); }
  [[nodiscard]] std::size_t leaves() const { return leaves_.size(); }
  [[nodiscard]] std::uint32_t depth() const { return depth_; }
  /// Number of pieces in nodes and leaves.
  [[nodiscard]] std::size_t references() const { return references_.size(); }
  [[nodiscard]] std::uint64_t memory_bytes() const;

 private:
  friend class BspBuilder;

  /// A range of `references_`.
  struct Range {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
  };
  struct Node {
    BspPlane plane;
    Range in_plane;
    std::uint32_t behind = kNothing;
    std::uint32_t in_front = kNothing;
  };

  /// A child is a node, or a leaf with this bit set, or nothing.
  static constexpr std::uint32_t kLeafBit = 0x80000000U;
  static constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();

  [[nodiscard]] std::span<const std::uint32_t> triangles_of(const Range& range) const {
    return std::span(references_).subspan(range.begin, range.end - range.begin);
  }
  /// Bound of the error of a distance between the body and a plane, as a bound for a triangle.
  [[nodiscard]] double margin_m(const geometry::Box& body) const;
  template <class Search>
  void run(Search& search, QueryCost& cost) const;

  std::shared_ptr<const scene::Mesh> mesh_;
  geometry::Box bounds_;
  std::vector<Node> nodes_;
  std::vector<Range> leaves_;
  std::vector<std::uint32_t> references_;
  std::uint32_t root_ = kNothing;
  std::uint32_t depth_ = 0;
};

}  // namespace camway::bench
