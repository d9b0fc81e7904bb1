// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <cmath>

#include "daemon/geometry/rounding.h"
#include "daemon/geometry/triangle_box.h"
#include "daemon/scene/scene_index.h"

namespace camway::scene {

using geometry::Box;
using geometry::Triangle;
using geometry::Vec3;

namespace {

/// A cube a little larger than `bounds`. A cube, so that cells do not become flatter than the scene
/// asks for; larger, so that a floor at the very bottom lies inside the lower octants and not on
/// their boundary, and so that the rounding of a cell's middle never leaves the cell.
Box root_cell(const Box& bounds) {
  const double largest = bounds.min().cwiseAbs().cwiseMax(bounds.max().cwiseAbs()).maxCoeff();
  const double extent = bounds.sizes().maxCoeff();
  // The middle of a cell has a rounding of u·largest at each of at most 20 levels.
  const double margin = std::max(
      {0x1p-30 * extent, 64.0 * geometry::kUnitRoundoff * largest, geometry::kSmallestNormal});
  const Vec3 low = bounds.min() - Vec3::Constant(margin);
  return {low, low + Vec3::Constant(extent + 3.0 * margin)};
}

}  // namespace

/// Top down: a node's triangles are dealt to its octants, then each octant is built in turn.
class OctreeBuilder {
 public:
  OctreeBuilder(SceneIndex& tree, const IndexOptions& options) : tree_(tree), options_(options) {}

  void build() {
    const std::size_t count = tree_.triangles_.size();
    std::vector<std::uint32_t> all(count);
    for (std::size_t i = 0; i < count; ++i) all[i] = static_cast<std::uint32_t>(i);
    tree_.leaf_begin_.push_back(0);
    tree_.nodes_.emplace_back();
    const double budget = std::max(1.0, options_.max_duplication) * static_cast<double>(count);
    build_node(0, root_cell(tree_.bounds_), std::move(all), budget, 0);
  }

 private:
  using Octants = std::array<std::vector<std::uint32_t>, 8>;

  /// `budget` is how many entries the leaves below this node may have.
  void build_node(std::uint32_t node, const Box& cell, std::vector<std::uint32_t> members,
                  double budget, std::uint32_t depth) {
    tree_.statistics_.depth = std::max(tree_.statistics_.depth, depth);
    if (members.size() > options_.threshold && depth < options_.max_depth) {
      const Vec3 middle = 0.5 * cell.min() + 0.5 * cell.max();
      const bool splits_space =
          (middle.array() > cell.min().array() && middle.array() < cell.max().array()).all();
      if (splits_space) {
        Octants octants = deal(cell, middle, members);
        if (worth_splitting(octants, members.size(), budget)) {
          members = {};
          build_children(node, cell, middle, octants, budget, depth);
          return;
        }
      }
    }
    make_leaf(node, cell, members);
  }

  static Box octant_cell(const Box& cell, const Vec3& middle, std::size_t octant) {
    Box result = cell;
    for (int k = 0; k < 3; ++k) {
      if ((octant >> k) & 1U) {
        result.min()[k] = middle[k];
      } else {
        result.max()[k] = middle[k];
      }
    }
    return result;
  }

  /// Octants are closed, so a triangle on the plane between two goes to both.
  Octants deal(const Box& cell, const Vec3& middle,
               const std::vector<std::uint32_t>& members) const {
    std::array<Box, 8> cells;
    for (std::size_t octant = 0; octant < 8; ++octant) {
      cells[octant] = octant_cell(cell, middle, octant);
    }
    Octants octants;
    for (const std::uint32_t index : members) {
      const Triangle& triangle = tree_.triangles_[index];
      const Box box = geometry::bounds(triangle);
      for (std::size_t octant = 0; octant < 8; ++octant) {
        if (!cells[octant].intersects(box)) continue;
        // A box inside one cell needs no further test.
        if (cells[octant].contains(box) ||
            geometry::triangle_touches_box(triangle, cells[octant])) {
          octants[octant].push_back(index);
        }
      }
    }
    return octants;
  }

  /// Not if the copies would pass the budget, nor if the octants would on average hold nearly all
  /// again: then a query visits more and discards nothing.
  static bool worth_splitting(const Octants& octants, std::size_t members, double budget) {
    constexpr double kNearlyAll = 0.8;
    std::size_t entries = 0;
    std::size_t occupied = 0;
    for (const std::vector<std::uint32_t>& octant : octants) {
      entries += octant.size();
      occupied += octant.empty() ? 0U : 1U;
    }
    if (occupied == 1) return true;  // nothing is copied, and empty space goes
    const double average = static_cast<double>(entries) / static_cast<double>(occupied);
    return static_cast<double>(entries) <= budget &&
           average <= kNearlyAll * static_cast<double>(members);
  }

  void build_children(std::uint32_t node, const Box& cell, const Vec3& middle, Octants& octants,
                      double budget, std::uint32_t depth) {
    const auto first = static_cast<std::uint32_t>(tree_.nodes_.size());
    std::uint32_t count = 0;
    std::size_t entries = 0;
    for (const std::vector<std::uint32_t>& octant : octants) {
      entries += octant.size();
      count += octant.empty() ? 0U : 1U;
    }
    tree_.nodes_[node].first = first;
    tree_.nodes_[node].count = count;
    tree_.nodes_.resize(tree_.nodes_.size() + count);
    std::uint32_t child = first;
    Box box;
    for (std::size_t octant = 0; octant < 8; ++octant) {
      if (octants[octant].empty()) continue;
      const double share =
          budget * (static_cast<double>(octants[octant].size()) / static_cast<double>(entries));
      build_node(child, octant_cell(cell, middle, octant), std::move(octants[octant]), share,
                 depth + 1);
      box.extend(tree_.nodes_[child].box);
      ++child;
    }
    tree_.nodes_[node].box = box;
  }

  void make_leaf(std::uint32_t node, const Box& cell, const std::vector<std::uint32_t>& members) {
    Box box;
    for (const std::uint32_t index : members) {
      box.extend(geometry::bounds(tree_.triangles_[index]).intersection(cell));
    }
    tree_.nodes_[node].box = box;
    tree_.nodes_[node].first = static_cast<std::uint32_t>(tree_.leaf_begin_.size() - 1);
    tree_.references_.insert(tree_.references_.end(), members.begin(), members.end());
    tree_.leaf_begin_.push_back(static_cast<std::uint32_t>(tree_.references_.size()));
  }

  SceneIndex& tree_;
  IndexOptions options_;
};

SceneIndex SceneIndex::build(const Mesh& mesh, const IndexOptions& options) {
  assert(options.threshold >= 1 && options.max_depth <= kMaxIndexDepth);
  SceneIndex tree;
  tree.triangles_.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    tree.triangles_.push_back(mesh.triangle(i));
    tree.bounds_.extend(geometry::bounds(tree.triangles_.back()));
  }
  if (tree.triangles_.empty()) return tree;
  OctreeBuilder(tree, options).build();
  IndexStatistics& s = tree.statistics_;
  s.nodes = tree.nodes_.size();
  s.leaves = tree.leaf_begin_.size() - 1;
  s.triangles = tree.triangles_.size();
  s.references = tree.references_.size();
  s.duplication = static_cast<double>(s.references) / static_cast<double>(s.triangles);
  tree.nodes_.shrink_to_fit();
  tree.references_.shrink_to_fit();
  tree.leaf_begin_.shrink_to_fit();
  s.memory_bytes = tree.nodes_.size() * sizeof(Node) + tree.triangles_.size() * sizeof(Triangle) +
                   (tree.references_.size() + tree.leaf_begin_.size()) * sizeof(std::uint32_t);
  return tree;
}

}  // namespace camway::scene
