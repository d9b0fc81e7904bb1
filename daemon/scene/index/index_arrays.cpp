// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/index/index_tree.h"

namespace camway::scene {
namespace {

/// Exponents of the steps of boxes whose coordinates are below geometry::kLargestCoordinate_m =
/// 2^200: a side is below 2^201.
constexpr int kMaxExponent = 201;

bool is_usable(const ByteFrame& frame) {
  const auto is_step = [](std::int16_t exponent) {
    return exponent >= ByteFrame::kMinExponent && exponent <= kMaxExponent;
  };
  // False for NaN.
  const auto is_coordinate = [](double x) { return std::abs(x) < geometry::kLargestCoordinate_m; };
  return std::all_of(frame.exponent.begin(), frame.exponent.begin() + 3, is_step) &&
         frame.exponent[3] == 0 && std::ranges::all_of(frame.origin, is_coordinate);
}

/// Checks which node is whose child. Each child has a higher number than its parent, so one pass in
/// the order of the numbers knows the level of a node before it comes to it.
class TreeCheck {
 public:
  explicit TreeCheck(const IndexArrays& arrays)
      : arrays_(arrays),
        level_(arrays.nodes.size(), kNoParent),
        has_parent_(arrays.leaf_begin.size() - 1, false) {}

  bool holds() {
    level_[0] = 0;
    for (std::size_t at = 0; at < level_.size(); ++at) {
      if (level_[at] == kNoParent || !take_children(at)) return false;
    }
    return std::ranges::all_of(has_parent_, [](bool has) { return has; });
  }

 private:
  static constexpr std::uint8_t kNoParent = 255;
  /// A part that cannot be split becomes a node with one leaf, which adds a level; see `IndexWalk`.
  static constexpr std::uint8_t kMaxLevel = kMaxIndexDepth + 1;

  bool take_children(std::size_t at) {
    const IndexNode& node = arrays_.nodes[at];
    if (node.child_count < 1 || node.child_count > kNodeWidth || !is_usable(node.frame) ||
        node.node_count > node.child_count || level_[at] > kMaxLevel) {
      return false;
    }
    const std::size_t first = node.first_node;
    const std::size_t first_leaf = node.first_leaf;
    const std::size_t leaves = static_cast<std::size_t>(node.child_count) - node.node_count;
    if (node.node_count > 0 && first <= at) return false;
    if (first + node.node_count > level_.size() || first_leaf + leaves > has_parent_.size()) {
      return false;
    }
    for (std::size_t child = first; child < first + node.node_count; ++child) {
      if (level_[child] != kNoParent) return false;
      level_[child] = static_cast<std::uint8_t>(level_[at] + 1);
    }
    for (std::size_t leaf = first_leaf; leaf < first_leaf + leaves; ++leaf) {
      if (has_parent_[leaf]) return false;
      has_parent_[leaf] = true;
    }
    return true;
  }

  const IndexArrays& arrays_;
  std::vector<std::uint8_t> level_;
  std::vector<bool> has_parent_;  ///< of each leaf
};

/// Whether each leaf has items that increase and are below `items`.
bool has_sound_leaves(const IndexArrays& arrays, std::size_t items) {
  const base::Array<std::uint32_t>& begin = arrays.leaf_begin;
  if (begin.front() != 0 || begin.back() != arrays.references.size()) return false;
  // Before any reference is read: then all ranges lie between the first and the last begin.
  if (!std::ranges::is_sorted(begin)) return false;
  for (std::size_t leaf = 0; leaf + 1 < begin.size(); ++leaf) {
    if (begin[leaf] == begin[leaf + 1]) return false;
    std::int64_t before = -1;
    for (std::size_t i = begin[leaf]; i < begin[leaf + 1]; ++i) {
      if (arrays.references[i] <= before) return false;
      before = arrays.references[i];
    }
    if (static_cast<std::size_t>(before) >= items) return false;
  }
  return true;
}

}  // namespace

std::string fault_in(const IndexArrays& arrays, std::size_t items) {
  if (arrays.nodes.empty() || arrays.leaf_begin.size() < 2) return "the tree has no leaf";
  if (arrays.boxes.size() != (arrays.references.size() + kNodeWidth - 1) / kNodeWidth) {
    return "the tree has not as many boxes as entries";
  }
  if (arrays.depth > kMaxIndexDepth) return "the tree is too deep";
  if (!has_sound_leaves(arrays, items)) return "the leaves of the tree are wrong";
  if (!TreeCheck(arrays).holds()) return "the nodes of the tree are wrong";
  return {};
}

base::Result<IndexTree> IndexTree::of_arrays(IndexArrays arrays, std::size_t items,
                                             const geometry::Box& bounds) {
  if (std::string fault = fault_in(arrays, items); !fault.empty()) {
    return base::Failure{std::move(fault)};
  }
  IndexTree tree;
  tree.bounds_ = bounds;
  tree.arrays_ = std::move(arrays);
  return tree;
}

}  // namespace camway::scene
