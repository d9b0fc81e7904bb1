// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/mesh.h"
#include "daemon/scene/scene_index.h"

/// How the index is built: one builder for all decompositions, and a dealer for each.
namespace camway::scene {

/// A triangle in a part of the scene.
struct IndexEntry {
  geometry::Box box;  ///< holds what of the triangle lies in the part
  std::uint32_t triangle = 0;
};

/// What a child of a node is made of.
struct IndexPart {
  geometry::Box cell;               ///< its share of space; empty where space is not shared out
  geometry::Box box;                ///< holds the boxes of the entries
  std::vector<IndexEntry> entries;  ///< triangles increasing
  double budget = 0.0;              ///< how many entries the leaves below may have
  std::uint32_t depth = 0;          ///< levels below the root
  bool is_final = false;            ///< splitting it was found not to pay
};

/// Deals the entries of a part to the children of a node. Const calls are safe from any thread, and
/// the result depends on the arguments only.
class IndexDealer {
 public:
  virtual ~IndexDealer() = default;

  /// At most `kNodeWidth` parts, none of them empty, that hold what `part` holds; or none, and
  /// `part` as it was, where it shall not be split.
  [[nodiscard]] virtual std::vector<IndexPart> deal(IndexPart& part) const = 0;
};

/// Precondition: `mesh` outlives the dealer.
std::unique_ptr<IndexDealer> make_octree_dealer(const Mesh& mesh, const IndexOptions& options);
std::unique_ptr<IndexDealer> make_kd_tree_dealer(const Mesh& mesh, const IndexOptions& options);
std::unique_ptr<IndexDealer> make_bvh_dealer(const IndexOptions& options);

/// Cuts what lies in a part by a plane `x[axis] = at`.
class TriangleCutter {
 public:
  /// Rounding of a point where an edge meets a plane, in units of 2^-53 of the largest coordinate:
  /// the parameter has two differences and a quotient (3), its product with a difference two more,
  /// all relative to an edge of at most twice that size (10), the sum one; 16 leaves room for the
  /// second order.
  static constexpr double kCutErrorUnits = 16.0;

  TriangleCutter(const Mesh& mesh, const geometry::Box& bounds);

  /// Replaces `low` and `high` by what of `entry` lies at most, and at least, at the plane. Their
  /// boxes are rounded outwards; one that is empty proves that nothing lies there.
  /// Precondition: `entry.box` has points on both sides of the plane.
  void cut(const IndexEntry& entry, int axis, double at, IndexEntry& low, IndexEntry& high) const;

 private:
  const Mesh& mesh_;
  double error_m_;
};

/// About half the surface area of a box: how likely a query is to meet it. A box that is a line
/// counts a little, by its length. 0 for an empty one.
double half_area_m2(const geometry::Box& box);

}  // namespace camway::scene
