// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/index/index_tree.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::scene {

struct IndexStatistics {
  std::uint64_t nodes = 0;   ///< inner nodes and leaves of all trees
  std::uint64_t leaves = 0;  ///< each holds at least one triangle
  std::uint32_t depth = 0;
  std::uint64_t triangles = 0;
  std::uint64_t references = 0;    ///< triangle entries in leaves, duplicates included
  double duplication = 0.0;        ///< references / triangles
  std::uint64_t memory_bytes = 0;  ///< of the trees, without meshes that it shares

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

/// What a search by distance ends with.
enum class DistanceGoal : std::uint8_t {
  kNearest,
  kNear,  ///< once one is found, only what is nearer than `share` of it or `certain_m`
  kAny,
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

/// A mesh in a scene, and how its triangles and leaves are numbered there.
struct IndexedPart {
  std::shared_ptr<const IndexedMesh> indexed;
  std::uint32_t first_triangle = 0;
  std::uint32_t first_leaf = 0;

  /// Triangle `index` of the scene. Precondition: it lies in this part.
  [[nodiscard]] geometry::Triangle triangle(std::uint32_t index) const {
    return indexed->mesh->triangle(index - first_triangle);
  }
};

/// The triangles of a leaf: `first + number` for each of `numbers`, which increase.
struct LeafTriangles {
  std::uint32_t first = 0;
  std::span<const std::uint32_t> numbers;
};

/// The triangles of a scene, found by where they are, on two levels: a tree for each mesh, and one
/// over the boxes of the meshes. So a scene in which one mesh changes shares the trees of all
/// others with what it was before. Triangles are numbered through, mesh after mesh.
///
/// What a query answers does not depend on the trees: it is what asking every triangle in turn with
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

  /// Of one mesh, which it shares. The result depends on the mesh and the options only, not on the
  /// threads. Preconditions: not null; coordinates are below geometry::kLargestCoordinate_m.
  static SceneIndex build(std::shared_ptr<const Mesh> mesh, const IndexOptions& options = {});

  /// The same with a copy of `mesh`, which then counts as memory of the index.
  static SceneIndex build(const Mesh& mesh, const IndexOptions& options = {});

  /// Of several meshes, which it shares, in their order. Costs what there are meshes, whatever is
  /// in them. Preconditions: none is null; together they have fewer than 2^32 triangles.
  static SceneIndex of(std::span<const std::shared_ptr<const IndexedMesh>> meshes);

  [[nodiscard]] const IndexStatistics& statistics() const { return statistics_; }
  [[nodiscard]] const geometry::Box& bounds() const { return bounds_; }
  /// Number of triangles.
  [[nodiscard]] std::size_t size() const { return statistics_.triangles; }
  /// Triangle `index` of the scene. [Limit: index < size()]
  [[nodiscard]] geometry::Triangle triangle(std::size_t index) const {
    const auto number = static_cast<std::uint32_t>(index);
    return part_of(number).triangle(number);
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

  /// Whether the two have equal trees, bit for bit: then they answer everything alike.
  [[nodiscard]] bool has_same_trees_as(const SceneIndex& other) const;

  /// The scene triangles of a leaf. [Limit: leaf < statistics().leaves]
  [[nodiscard]] LeafTriangles leaf_triangles(std::uint32_t leaf) const;

 private:
  /// Runs `query` through the trees of all parts that it is interested in.
  template <class Query>
  void run(Query& query) const;

  [[nodiscard]] const IndexedPart& part_of(std::uint32_t triangle) const {
    if (parts_.size() == 1) return parts_.front();
    return *std::prev(std::ranges::upper_bound(parts_, triangle, {}, &IndexedPart::first_triangle));
  }

  void add(const std::shared_ptr<const IndexedMesh>& mesh);
  bool visit_touching(const geometry::Box& box, bool (*visit)(void*, std::uint32_t),
                      void* context) const;
  template <class Visit>
  void visit_leaves(const geometry::Triangle& triangle, const Visit& visit) const;
  [[nodiscard]] std::optional<Nearest> search(std::span<const geometry::Triangle> body,
                                              double cutoff_m, DistanceGoal goal,
                                              double certain_m = 0.0, double share = 1.0) const;

  std::vector<IndexedPart> parts_;  ///< those with triangles
  IndexTree top_;                   ///< over `parts_`, where there are several
  geometry::Box bounds_;
  IndexStatistics statistics_;
};

}  // namespace camway::scene
