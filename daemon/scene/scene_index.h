// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/index_node.h"
#include "daemon/scene/mesh.h"

namespace camway::scene {

/// How the triangles are dealt to the nodes of the tree. Queries give the same answers with all.
enum class Decomposition : std::uint8_t {
  kOctree,  ///< space into octants; a triangle goes to every octant that it lies in
  kKdTree,  ///< space by a plane, at the least surface area; a triangle goes to every side
  kBvh,     ///< triangles into two groups, at the least surface area; boxes may overlap
};

/// When a node splits, what bounds the tree whatever the input, and who builds it.
struct IndexOptions {
  Decomposition decomposition = Decomposition::kOctree;
  std::uint32_t threshold =
      16;  ///< a leaf with more triangles than this splits [Limit: value >= 1]
  std::uint32_t max_depth = 16;  ///< levels below the root [Limit: value <= kMaxIndexDepth]
  /// Largest number of triangle entries in leaves per triangle of the mesh; a node whose split
  /// would pass its share of that stays a leaf. [Limit: value >= 1]
  double max_duplication = 8.0;
  /// Threads that build; 0 for as many as the machine has. Never more than kMaxIndexThreads, and
  /// without any influence on the result.
  unsigned threads = 0;
};

inline constexpr std::uint32_t kMaxIndexDepth = 20;
inline constexpr unsigned kMaxIndexThreads = 8;

struct IndexStatistics {
  std::uint64_t nodes = 0;   ///< inner nodes and leaves; octants without a triangle are not stored
  std::uint64_t leaves = 0;  ///< each holds at least one triangle
  std::uint32_t depth = 0;
  std::uint64_t triangles = 0;
  std::uint64_t references = 0;    ///< triangle entries in leaves, duplicates included
  double duplication = 0.0;        ///< references / triangles
  std::uint64_t memory_bytes = 0;  ///< of the index, without a mesh that it shares

  bool operator==(const IndexStatistics&) const = default;
};

/// Where a line segment meets the scene first.
struct SegmentHit {
  double fraction = 0.0;       ///< in [0, 1] along the segment, from `from` to `to`
  std::uint32_t triangle = 0;  ///< index in the mesh
};

/// What is nearest to a body.
struct Nearest {
  double distance_m = 0.0;
  std::uint32_t triangle = 0;
};

/// A body on a short way. What it refers to must outlive it.
struct MovingBody {
  std::span<const geometry::Triangle> middle;  ///< its triangles half way
  /// Of each triangle where it begins and where it ends. Every point of the body is always within
  /// `bend_m` of the straight line between its own two ends.
  std::span<const geometry::Triangle> ends;
  double bend_m = 0.0;
  double reach_m = 0.0;  ///< nor is it ever further than this from where it is half way
  /// The distance to keep from the scene, and what rounding makes of distances
  /// (`SceneIndex::nearest_error_m` of the ends).
  double keep_m = 0.0;
};

/// Whether a moving body keeps away from the scene.
struct Passage {
  /// Proved: no point of the body ever comes as near as it should keep.
  bool is_clear = false;
  /// What was met nearest to the body half way. Others may be nearer than that if the passage is
  /// not clear.
  std::optional<Nearest> nearest;
  /// An estimate, not a proof: how many times as long the way may be. If this one is clear, the
  /// next one, from its end on; else another one from the same beginning. Infinity where nothing
  /// was met.
  double ahead = 0.0;
};

/// A spatial decomposition of the scene (Ptacek & Johnstone 2006, section 3, for the octree). One
/// structure for all decompositions: a tree of wide nodes in flat arrays, with boxes of a byte per
/// side. Each node keeps the box that its triangles really fill, so that empty space is skipped at
/// once. Bounded in depth and in duplication: what cannot be told apart by splitting (a fan of
/// triangles at one vertex) stays in one leaf.
///
/// What a query answers does not depend on the tree: it is what asking every triangle in turn with
/// the kernels of daemon/geometry would answer, bit for bit; only `near` and `any_within` are free
/// to choose. Who asks with a coordinate that is not finite, or beyond
/// geometry::kLargestCoordinate_m, is told that triangle 0 is at distance 0: never that the space
/// is free.
///
/// Immutable; queries are safe from any thread and allocate nothing unless they say so.
class SceneIndex {
 public:
  /// No triangles; every query answers nothing.
  SceneIndex() = default;

  /// Shares the mesh. The result depends on the mesh and the options only, not on the threads.
  /// Preconditions: not null; coordinates are below geometry::kLargestCoordinate_m.
  static SceneIndex build(std::shared_ptr<const Mesh> mesh, const IndexOptions& options = {});

  /// The same with a copy of `mesh`, which then counts as memory of the index.
  static SceneIndex build(const Mesh& mesh, const IndexOptions& options = {});

  [[nodiscard]] const IndexStatistics& statistics() const { return statistics_; }
  [[nodiscard]] const geometry::Box& bounds() const { return bounds_; }
  /// Number of triangles.
  [[nodiscard]] std::size_t size() const { return mesh_ ? mesh_->triangles.size() : 0; }
  /// Triangle `index` of the mesh. [Limit: index < size()]
  [[nodiscard]] geometry::Triangle triangle(std::size_t index) const {
    return mesh_->triangle(index);
  }

  /// Index of a scene triangle that `triangle` touches, or nothing. Touching counts, without any
  /// tolerance (`geometry::triangles_touch`). The lowest index among all of them.
  [[nodiscard]] std::optional<std::uint32_t> first_intersection(
      const geometry::Triangle& triangle) const;

  /// Whether `triangle` touches any scene triangle; as `first_intersection`, but stops at the
  /// first.
  [[nodiscard]] bool intersects(const geometry::Triangle& triangle) const;

  /// The hit closest to `segment.from` (`geometry::hit_fraction`), or nothing. Ties go to the
  /// lowest index.
  [[nodiscard]] std::optional<SegmentHit> closest_hit(const geometry::LineSegment& segment) const;

  /// The scene triangle nearest to the body made of `body` triangles, if it is nearer than
  /// `cutoff_m` (infinity for no cut-off); distance 0 where they touch. Ties go to the lowest
  /// index. The error of the distance is at most `nearest_error_m(body)`.
  [[nodiscard]] std::optional<Nearest> nearest(std::span<const geometry::Triangle> body,
                                               double cutoff_m) const;

  /// As `nearest`, but any triangle whose distance, times `share`, is not more than the least: much
  /// faster near finely divided surfaces. Nothing exactly if `nearest` gives nothing, distance 0
  /// exactly if it does, and less than `certain_m` exactly if it does. Which of several it is
  /// depends on the index alone. [Limit: 0 < share <= 1]
  [[nodiscard]] std::optional<Nearest> near(std::span<const geometry::Triangle> body,
                                            double cutoff_m, double certain_m, double share) const;

  /// Whether the body keeps away from the scene on its way: of every triangle that is near this is
  /// asked, until there is one which the body may meet.
  ///
  /// A triangle of the body is all the time within `bend_m` of the convex hull of its two ends. So
  /// it keeps away from a triangle of the scene if both ends lie beyond a slab wider than `bend_m +
  /// keep_m`: tried is the one across the shortest line half way. Or if it is further away half way
  /// than `reach_m + keep_m`.
  [[nodiscard]] Passage passage(const MovingBody& body) const;

  /// A scene triangle that is nearer to the body than `distance_m`, and its own distance, or
  /// nothing if there is none; the search ends at the first that it meets. Which of several it is
  /// depends on the index, and on nothing else. Nothing proves that all triangles are at least
  /// `distance_m - nearest_error_m(body)` away.
  [[nodiscard]] std::optional<Nearest> any_within(std::span<const geometry::Triangle> body,
                                                  double distance_m) const;

  /// Calls `visit(index)` for every triangle that has a point in the closed `box`, until it returns
  /// false; then returns false. Conservative: visits others whose bounding boxes meet `box` as
  /// well, and may visit a triangle more than once.
  template <class Visit>
  bool for_each_touching(const geometry::Box& box, Visit&& visit) const {
    return visit_touching(
        box,
        [](void* context, std::uint32_t index) {
          return static_cast<bool>((*static_cast<std::remove_reference_t<Visit>*>(context))(index));
        },
        const_cast<void*>(static_cast<const void*>(&visit)));
  }

  /// Bound of the rounding error of the distance that `nearest` and `any_within` give for `body`,
  /// metres.
  [[nodiscard]] double nearest_error_m(std::span<const geometry::Triangle> body) const;

  /// Replaces `out` by the ids of all leaves whose cell `triangle` touches, in increasing order.
  /// Conservative: a scene triangle that it touches is in one of them. Allocates in `out` only.
  void leaves_touching(const geometry::Triangle& triangle, std::vector<std::uint32_t>& out) const;

  /// Whether the two have equal arrays, bit for bit: then they answer everything alike.
  [[nodiscard]] bool has_same_tree_as(const SceneIndex& other) const;

  /// Indices of the scene triangles of a leaf, increasing. [Limit: leaf < statistics().leaves]
  [[nodiscard]] std::span<const std::uint32_t> leaf_triangles(std::uint32_t leaf) const;

 private:
  friend class IndexAssembler;
  friend class IndexWalk;

  void count();  ///< fills statistics_ but for the depth
  bool visit_touching(const geometry::Box& box, bool (*visit)(void*, std::uint32_t),
                      void* context) const;

  std::shared_ptr<const Mesh> mesh_;
  geometry::Box bounds_;
  std::vector<IndexNode> nodes_;           ///< the root first
  std::vector<std::uint32_t> leaf_begin_;  ///< leaf i holds references_[leaf_begin_[i] .. [i + 1])
  std::vector<std::uint32_t> references_;
  std::vector<ByteBoxes> boxes_;  ///< of references_, eight at a time, in the frame of the parent
  IndexStatistics statistics_;
};

}  // namespace camway::scene
