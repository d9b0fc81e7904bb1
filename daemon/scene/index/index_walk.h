// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <limits>

#include "daemon/scene/index/box_gaps.h"
#include "daemon/scene/index/index_tree.h"

namespace camway::scene {

/// Numbers of the first entry and the first leaf of a tree, where there are several trees.
struct IndexOffsets {
  std::uint32_t entry = 0;
  std::uint32_t leaf = 0;
};

/// The traversal of all queries: depth first, nearer children first, without what is beyond a reach
/// that the query may shrink on the way. A query has
///
///     const BoxSides& sides() const           the box that the query is about
///     const ObliqueSides* oblique() const     the same along its own axes, or null
///     double squared_reach_m2() const         square of the reach from that box
///     bool is_beyond(double squared) const    whether a squared box distance is beyond the reach
///     bool enters(node, slot) const           false if a closer test excludes a child
///     void leaf(const IndexWalk::Leaf&)       tests the entries of a leaf
///     bool is_done() const                    whether to stop
class IndexWalk {
 public:
  explicit IndexWalk(const IndexTree& tree, const IndexOffsets& offsets = {})
      : tree_(tree), offsets_(offsets) {}

  /// A leaf, whose entries within reach a query visits.
  class Leaf {
   public:
    Leaf(IndexWalk& walk, std::uint32_t parent, std::uint32_t leaf)
        : walk_(walk), parent_(parent), leaf_(leaf) {}

    [[nodiscard]] std::uint32_t id() const { return walk_.offsets_.leaf + leaf_; }

    /// Calls `visit(entry)` for each entry whose box is within reach, until `visit` returns false.
    template <class Query, class Visit>
    void for_each(const Query& query, const Visit& visit) const {
      const IndexArrays& arrays = walk_.tree_.arrays_;
      const std::uint32_t begin = arrays.leaf_begin[leaf_];
      const std::uint32_t end = arrays.leaf_begin[leaf_ + 1];
      const FramedBox& box = walk_.box_in(query, parent_);
      BoxGaps gaps;
      for (std::uint32_t first = begin - begin % kNodeWidth; first < end; first += kNodeWidth) {
        box_gaps(box, arrays.boxes[first / kNodeWidth], query.squared_reach_m2(), gaps);
        // A group of eight boxes may belong to several leaves.
        unsigned near = gaps.near;
        if (first < begin) near &= 0xFFU << (begin - first);
        if (end - first < kNodeWidth) near &= (1U << (end - first)) - 1U;
        for (; near != 0; near &= near - 1U) {
          const auto i = static_cast<std::uint32_t>(std::countr_zero(near));
          if (!visit(walk_.offsets_.entry + arrays.references[first + i])) return;
        }
      }
    }

   private:
    IndexWalk& walk_;
    std::uint32_t parent_;
    std::uint32_t leaf_;
  };

  template <class Query>
  void run(Query& query) {
    if (tree_.arrays_.nodes.empty()) return;
    push({0.0, 0, kNode});
    while (size_ > 0) {
      const Waiting top = stack_[--size_];
      if (query.is_beyond(top.squared_m2)) continue;
      if (top.leaf == kNode) {
        push_children(query, top.node);
      } else {
        query.leaf(Leaf(*this, top.node, top.leaf));
        if (query.is_done()) return;
      }
    }
  }

 private:
  static constexpr std::uint32_t kNode = std::numeric_limits<std::uint32_t>::max();
  /// Depth first, each level leaves at most seven siblings waiting. A large part that cannot be
  /// split becomes a node with one leaf, which adds a level.
  static constexpr std::size_t kStackSize = (kNodeWidth - 1) * (kMaxIndexDepth + 1) + kNodeWidth;

  struct Waiting {
    double squared_m2;
    std::uint32_t node;  ///< the node, or the parent of the leaf
    std::uint32_t leaf;  ///< the leaf; kNode for a node
  };

  /// The box of the query in the frame of a node. The leaves below a node have its frame, and are
  /// mostly looked at right after it.
  template <class Query>
  const FramedBox& box_in(const Query& query, std::uint32_t node) {
    if (framed_in_ != node) {
      put_in_frame(tree_.arrays_.nodes[node].frame, query.sides(), query.oblique(), framed_);
      framed_in_ = node;
    }
    return framed_;
  }

  void push(const Waiting& waiting) { stack_[size_++] = waiting; }

  template <class Query>
  void push_children(const Query& query, std::uint32_t at) {
    const IndexNode& node = tree_.arrays_.nodes[at];
    BoxGaps gaps;
    box_gaps(box_in(query, at), node.boxes, query.squared_reach_m2(), gaps);
    const std::size_t begin = size_;
    for (unsigned near = gaps.near & ((1U << node.child_count) - 1U); near != 0;
         near &= near - 1U) {
      const auto slot = static_cast<std::uint32_t>(std::countr_zero(near));
      if (!query.enters(node, slot)) continue;
      const double squared_m2 = static_cast<double>(gaps.squared[slot]) * gaps.square_m2;
      const bool is_leaf = slot >= node.node_count;
      // The nearest child on top; among equals the first.
      std::size_t place = size_++;
      for (; place > begin && stack_[place - 1].squared_m2 <= squared_m2; --place) {
        stack_[place] = stack_[place - 1];
      }
      stack_[place] = {squared_m2, is_leaf ? at : node.first_node + slot,
                       is_leaf ? node.first_leaf + slot - node.node_count : kNode};
    }
  }

  const IndexTree& tree_;
  IndexOffsets offsets_;
  std::size_t size_ = 0;
  std::array<Waiting, kStackSize> stack_;
  FramedBox framed_;
  std::uint32_t framed_in_ = kNode;  ///< node of whose frame `framed_` is
};

}  // namespace camway::scene
