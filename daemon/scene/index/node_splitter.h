// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/index/index_tree.h"
#include "daemon/scene/mesh/mesh.h"

/// How the trees are built: one builder for all, and a node splitter for each kind of tree.
namespace camway::scene {

/// A triangle in a part of the scene, with a box that holds the piece of it that lies there. Plain
/// numbers, because the builders do little else than move them. Entry 3 of both arrays is 0.
struct IndexEntry {
  IndexEntry() = default;
  IndexEntry(const geometry::Box& box, std::uint32_t index)
      : low_m{box.min()[0], box.min()[1], box.min()[2], 0.0},
        high_m{box.max()[0], box.max()[1], box.max()[2], 0.0},
        triangle(index) {}

  [[nodiscard]] bool is_empty() const {
    return low_m[0] > high_m[0] || low_m[1] > high_m[1] || low_m[2] > high_m[2];
  }
  [[nodiscard]] geometry::Box box() const {
    return {geometry::Vec3(low_m[0], low_m[1], low_m[2]),
            geometry::Vec3(high_m[0], high_m[1], high_m[2])};
  }

  std::array<double, 4> low_m;
  std::array<double, 4> high_m;
  std::uint32_t triangle;
};

/// The bounding box of entries that are added one by one.
class EntryBounds {
 public:
  EntryBounds() {
    low_m_.fill(std::numeric_limits<double>::infinity());
    high_m_.fill(-std::numeric_limits<double>::infinity());
  }
  void extend(const std::array<double, 4>& low_m, const std::array<double, 4>& high_m) {
    for (std::size_t k = 0; k < 4; ++k) {
      low_m_[k] = low_m[k] < low_m_[k] ? low_m[k] : low_m_[k];
      high_m_[k] = high_m[k] > high_m_[k] ? high_m[k] : high_m_[k];
    }
  }
  void extend(const IndexEntry& entry) { extend(entry.low_m, entry.high_m); }
  void extend(const EntryBounds& other) { extend(other.low_m_, other.high_m_); }
  /// Cuts off the box of `entry` where it is more than `error_m` outside of these bounds.
  void clip(IndexEntry& entry, double error_m) const {
    for (std::size_t k = 0; k < 3; ++k) {
      entry.low_m[k] = std::max(entry.low_m[k], low_m_[k] - error_m);
      entry.high_m[k] = std::min(entry.high_m[k], high_m_[k] + error_m);
    }
  }
  /// Empty if nothing was added.
  [[nodiscard]] geometry::Box box() const {
    return {geometry::Vec3(low_m_[0], low_m_[1], low_m_[2]),
            geometry::Vec3(high_m_[0], high_m_[1], high_m_[2])};
  }

 private:
  std::array<double, 4> low_m_;
  std::array<double, 4> high_m_;
};

inline geometry::Box bounds_of(const std::vector<IndexEntry>& entries) {
  EntryBounds bounds;
  for (const IndexEntry& entry : entries) bounds.extend(entry);
  return bounds.box();
}

/// The contents of a child of a node.
struct IndexPart {
  IndexPart() = default;
  // Eigen does not promise that boxes move without throwing, so vectors would copy parts.
  IndexPart(IndexPart&&) noexcept = default;
  IndexPart& operator=(IndexPart&&) noexcept = default;

  geometry::Box cell;               ///< the octant that it divides further; unused without octants
  geometry::Box box;                ///< holds the boxes of the entries
  std::vector<IndexEntry> entries;  ///< in increasing order of triangles
  double budget = 0.0;              ///< most entries that the leaves below may have
  std::uint32_t depth = 0;          ///< levels below the root
  bool is_final = false;            ///< whether a split was found not to pay
};

/// Node splitter: distributes the entries of a part to the children of a node. The result depends
/// on the arguments only.
/// Thread-safe.
class NodeSplitter {
 public:
  virtual ~NodeSplitter() = default;

  /// Moves the contents of `part` to at most `kNodeWidth` parts, none of them empty, and returns
  /// these. Returns none, and leaves the contents in `part`, if it shall not be split.
  [[nodiscard]] virtual std::vector<IndexPart> split(IndexPart& part) const = 0;
};

/// Splits space into octants; a triangle goes to every octant that it lies in. Requires that `mesh`
/// outlives the splitter and that `bounds` holds all of its triangles.
std::unique_ptr<NodeSplitter> make_octree_splitter(const Mesh& mesh, const geometry::Box& bounds,
                                                   const IndexOptions& options);

/// Splits boxes into groups of least surface area cost, without copies; the boxes of the groups may
/// overlap. For the tree over the meshes of a scene, which move as wholes: their boxes overlap.
std::unique_ptr<NodeSplitter> make_box_group_splitter(const IndexOptions& options);

/// Cuts entries by a plane `x[axis] = at`.
class TriangleCutter {
 public:
  /// Rounding error of a point where an edge meets a plane, in units of 2^-53 of the largest
  /// coordinate. The parameter has two differences and a quotient (3), its product with a
  /// difference two more, all relative to an edge of at most twice that size (10); the sum has one.
  /// 16 leaves room for the second order.
  static constexpr double kCutErrorUnits = 16.0;

  TriangleCutter(const Mesh& mesh, const geometry::Box& bounds);

  /// Sets `low` and `high` to the pieces of `entry` with x[axis] <= at and with x[axis] >= at.
  /// Their boxes are rounded outwards; an empty box proves that nothing lies there. Requires that
  /// `entry.box` has points on both sides of the plane.
  void cut(const IndexEntry& entry, int axis, double at, IndexEntry& low, IndexEntry& high) const;

 private:
  const Mesh& mesh_;
  double error_m_;
};

/// About half the surface area of a box, to which the probability that a query meets it is
/// proportional. A box that is a line counts a little, by its length. 0 for an empty box.
double half_area_m2(const geometry::Box& box);

}  // namespace camway::scene
