// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
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

class TreeBody;
class TreeSearch;

struct IndexStatistics {
  std::uint64_t nodes = 0;   ///< inner nodes of all trees, leaves of the trees of meshes
  std::uint64_t leaves = 0;  ///< each holds at least one triangle
  std::uint32_t depth = 0;
  std::uint64_t triangles = 0;
  std::uint64_t references = 0;    ///< triangle entries in leaves, duplicates included
  double duplication = 0.0;        ///< references / triangles
  std::uint64_t memory_bytes = 0;  ///< memory of the trees, without the shared meshes

  bool operator==(const IndexStatistics&) const = default;
};

/// The first point where a line segment meets the scene.
struct SegmentHit {
  double fraction = 0.0;       ///< in [0, 1] along the segment, from `from` to `to`
  std::uint32_t triangle = 0;  ///< index in the mesh
};

/// The scene triangle nearest to a body.
struct Nearest {
  double distance_m = 0.0;
  std::uint32_t triangle = 0;
};

/// When a search by distance ends.
enum class DistanceGoal : std::uint8_t {
  kNearest,
  /// The first triangle found at a distance d limits the search to triangles nearer than `share`·d,
  /// or than `certain_m` if that is more and not above d.
  kNear,
  kAny,
};

/// A body on a short motion. The triangles must outlive it.
struct SweptBody {
  /// The triangles of the body at the middle of the motion.
  std::span<const geometry::Triangle> middle;
  /// For each triangle its position at the beginning and its position at the end. Every point of
  /// the body stays within `bend_m` of the straight line between its own two end positions.
  std::span<const geometry::Triangle> ends;
  double bend_m = 0.0;
  double reach_m = 0.0;  ///< bound of the distance of any point from its middle position
  /// The required distance from the scene, plus the rounding error of distances
  /// (`SceneIndex::nearest_error_m` of the ends).
  double keep_m = 0.0;
};

/// The answer to a swept query: whether a moving body keeps its distance from the scene.
struct SweptResult {
  /// True if it is proved that every point of the body always keeps the required distance.
  bool is_clear = false;
  /// The nearest triangle among those tested, measured from the body at the middle of the motion.
  /// If the motion is not clear, others may be nearer.
  std::optional<Nearest> nearest;
  /// An estimate, not a proof: how many times as long as this motion another one may be. If this
  /// one is clear, the other one begins at its end; else it begins where this one begins. Infinity
  /// if no triangle was near.
  double step_scale = 0.0;
};

/// A mesh in a scene, with the numbers of its first triangle and its first leaf there.
struct IndexedPart {
  std::shared_ptr<const IndexedMesh> indexed;
  std::uint32_t first_triangle = 0;
  std::uint32_t first_leaf = 0;

  /// Triangle `index` of the scene. Requires that it lies in this part.
  [[nodiscard]] geometry::Triangle triangle(std::uint32_t index) const {
    return indexed->mesh->triangle(index - first_triangle);
  }
};

/// The triangles of a leaf: `first + number` for each of `numbers`, which increase.
struct LeafTriangles {
  std::uint32_t first = 0;
  std::span<const std::uint32_t> numbers;
};

/// The spatial index over the triangles of a scene, on two levels: a tree for each mesh, and one
/// over the boxes of the meshes. So a scene in which one mesh changes shares the trees of all
/// others with its predecessor. Triangles are numbered through, mesh after mesh.
///
/// The answers do not depend on the trees: they are, bit for bit, the answers of a loop over all
/// triangles with the kernels of daemon/geometry. Exceptions are `near` and `any_within`, which
/// choose among triangles, and `swept`, which tests a limited number. Requires finite coordinates
/// below geometry::kLargestCoordinate_m; otherwise queries return triangle 0 at distance 0, so that
/// invalid input never counts as free space.
///
/// Immutable. Thread-safe. Queries allocate nothing unless they say so.
class SceneIndex {
 public:
  /// An index without triangles; queries find nothing.
  SceneIndex() = default;

  /// The index of one mesh, which it shares. It depends on the mesh and the options, not on the
  /// threads. Requires a mesh, not null, with coordinates below geometry::kLargestCoordinate_m.
  static SceneIndex build(std::shared_ptr<const Mesh> mesh, const IndexOptions& options = {});

  /// The index of a copy of `mesh`, which counts as memory of the index.
  static SceneIndex build(const Mesh& mesh, const IndexOptions& options = {});

  /// The index of several meshes, which it shares, in their order. The cost depends on the number
  /// of meshes, not on their sizes. Requires that none is null and that together they have fewer
  /// than 2^32 triangles.
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

  /// The lowest index of a scene triangle that `triangle` touches, or nothing. Touching counts,
  /// without any tolerance (`geometry::triangles_touch`).
  [[nodiscard]] std::optional<std::uint32_t> first_intersection(
      const geometry::Triangle& triangle) const;

  /// Whether `triangle` touches any scene triangle; stops at the first one found.
  [[nodiscard]] bool intersects(const geometry::Triangle& triangle) const;

  /// The hit closest to `segment.from` (`geometry::hit_fraction`), or nothing. Ties go to the
  /// lowest index.
  [[nodiscard]] std::optional<SegmentHit> closest_hit(const geometry::LineSegment& segment) const;

  /// The scene triangle nearest to the body made of `body` triangles, if it is nearer than
  /// `cutoff_m` (infinity for no cut-off); distance 0 if they touch. Ties go to the lowest index.
  /// The error of the distance is at most `nearest_error_m(body)`.
  [[nodiscard]] std::optional<Nearest> nearest(std::span<const geometry::Triangle> body,
                                               double cutoff_m) const;

  /// Like `nearest`, but returns any triangle whose distance times `share` is at most the least
  /// distance: much faster near finely divided surfaces. Returns nothing, distance 0, or a distance
  /// below `certain_m` exactly if `nearest` does. The choice among several triangles depends on the
  /// index alone. [Limit: 0 < share <= 1]
  [[nodiscard]] std::optional<Nearest> near(std::span<const geometry::Triangle> body,
                                            double cutoff_m, double certain_m, double share) const;

  /// Swept query: whether the body keeps its distance from the scene during its motion. Tests near
  /// triangles, up to a limited number, until one cannot be proved clear.
  ///
  /// A triangle of the body always stays within `bend_m` of the convex hull of its two ends. So it
  /// is clear of a scene triangle if both ends lie beyond a slab wider than `bend_m + keep_m`; the
  /// slab tried is perpendicular to the shortest line at the middle of the motion. It is also clear
  /// if it is farther away than `reach_m + keep_m` at the middle of the motion.
  [[nodiscard]] SweptResult swept(const SweptBody& body) const;

  /// A scene triangle nearer to the body than `distance_m`, with its distance. The search ends at
  /// the first one that it meets, which depends on the index alone. Returns nothing if it finds
  /// none, which proves that all triangles are at least `distance_m - nearest_error_m(body)` away.
  [[nodiscard]] std::optional<Nearest> any_within(std::span<const geometry::Triangle> body,
                                                  double distance_m) const;

  /// Runs a search of the triangles near a body that has a tree.
  void search(TreeSearch& search) const;

  /// Whether a triangle of the scene is inside the closed surface of `body` as it was placed last,
  /// of which `is_inside` tells on which side a point is. Requires that the surface touches no
  /// triangle of the scene. So a part of the scene whose box it does not touch is on one side, and
  /// so is each triangle.
  [[nodiscard]] bool has_inside(const TreeBody& body,
                                const std::function<bool(const geometry::Vec3&)>& is_inside) const;

  /// Calls `visit(index)` for every triangle that has a point in the closed `box`, until it returns
  /// false; then returns false. Conservative: also visits triangles whose bounding boxes meet
  /// `box`, and may visit a triangle more than once.
  template <class Visit>
  bool for_each_touching(const geometry::Box& box, Visit&& visit) const {
    return visit_touching(
        box,
        [](void* context, std::uint32_t index) {
          return static_cast<bool>((*static_cast<std::remove_reference_t<Visit>*>(context))(index));
        },
        const_cast<void*>(static_cast<const void*>(&visit)));
  }

  /// Error bound of the distances that `nearest` and `any_within` return for `body`, metres.
  [[nodiscard]] double nearest_error_m(std::span<const geometry::Triangle> body) const;

  /// Replaces `out` by the ids of all leaves whose cell `triangle` touches, in increasing order.
  /// Conservative: every scene triangle that it touches is in one of them. Allocates in `out` only.
  void leaves_touching(const geometry::Triangle& triangle, std::vector<std::uint32_t>& out) const;

  /// Whether both indexes have equal trees, bit for bit, and so answer everything alike.
  [[nodiscard]] bool has_same_trees_as(const SceneIndex& other) const;

  /// The scene triangles of a leaf. [Limit: leaf < statistics().leaves]
  [[nodiscard]] LeafTriangles leaf_triangles(std::uint32_t leaf) const;

 private:
  /// `nearest_error_m` of a body in this box.
  [[nodiscard]] double error_m(const geometry::Box& body) const;
  /// Runs `query` through the trees of all parts within its reach.
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

  std::vector<IndexedPart> parts_;  ///< the meshes that have triangles
  IndexTree top_;                   ///< tree over `parts_`, if there are several
  geometry::Box bounds_;
  IndexStatistics statistics_;
};

}  // namespace camway::scene
