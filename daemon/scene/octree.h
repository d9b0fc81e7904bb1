// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/mesh.h"

namespace camway::scene {

/// When a node splits, and what bounds the tree whatever the input.
struct OctreeOptions {
  std::uint32_t threshold = 32;  ///< a leaf with more triangles than this splits [Limit: value >= 1]
  std::uint32_t max_depth = 16;  ///< levels below the root [Limit: value <= 20]
};

struct OctreeStatistics {
  std::uint64_t nodes = 0;
  std::uint64_t leaves = 0;
  std::uint32_t depth = 0;
  std::uint64_t triangles = 0;
  std::uint64_t references = 0;  ///< triangle entries in leaves, duplicates included
  double duplication = 0.0;      ///< references / triangles
  std::uint64_t memory_bytes = 0;
};

/// Where a line segment meets the scene first.
struct SegmentHit {
  double fraction = 0.0;         ///< in [0, 1] along the segment, from `from` to `to`
  std::uint32_t triangle = 0;    ///< index in the mesh
};

/// What is nearest to a body.
struct Nearest {
  double distance_m = 0.0;
  std::uint32_t triangle = 0;
};

/// The paper's spatial decomposition (Ptacek & Johnstone 2006, section 3): a leaf that passes the
/// threshold splits into eight octants, and a triangle goes to every octant that it lies in.
/// Deviation: built from the whole mesh at once into flat arrays, bounded in depth, and a node whose
/// octants would hold nearly all of its triangles again stays a leaf (a fan of triangles at one
/// vertex cannot be separated by splitting). Immutable; queries are safe from any thread.
class Octree {
 public:
  Octree() = default;

  /// Keeps its own copy of the triangles. The result depends only on the arguments.
  static Octree build(const Mesh& mesh, const OctreeOptions& options = {});

  [[nodiscard]] const OctreeStatistics& statistics() const { return statistics_; }
  [[nodiscard]] const geometry::Box& bounds() const { return bounds_; }
  [[nodiscard]] std::span<const geometry::Triangle> triangles() const { return triangles_; }

  /// Index of a scene triangle that `triangle` touches, or nothing. Touching counts, and so does a
  /// gap below the rounding bound of the test. The lowest index among all of them.
  [[nodiscard]] std::optional<std::uint32_t> first_intersection(
      const geometry::Triangle& triangle) const;

  /// Whether `triangle` touches any scene triangle; as `first_intersection`, but stops at the first.
  [[nodiscard]] bool intersects(const geometry::Triangle& triangle) const;

  /// The hit closest to `segment.from`, or nothing.
  [[nodiscard]] std::optional<SegmentHit> closest_hit(const geometry::LineSegment& segment) const;

  /// The scene triangle nearest to the body made of `body` triangles, if it is nearer than
  /// `cutoff_m`; distance 0 where they touch. Ties go to the lowest index.
  [[nodiscard]] std::optional<Nearest> nearest(std::span<const geometry::Triangle> body,
                                               double cutoff_m) const;

 private:
  geometry::Box bounds_;
  std::vector<geometry::Triangle> triangles_;
  OctreeStatistics statistics_;
};

}  // namespace camway::scene
