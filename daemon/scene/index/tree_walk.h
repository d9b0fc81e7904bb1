// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "daemon/scene/index/index_tree.h"
#include "daemon/scene/index/index_walk.h"
#include "daemon/scene/index/tree_search.h"

namespace camway::scene {

/// The descent of the tree of a body and the tree of a part of the scene together: depth first,
/// nearer pairs of nodes first. Each step goes down one level of the scene, and down in the body
/// where its node is much longer than those of the scene. For the rest `TreeSearch::ask` goes down.
class TreeWalk {
 public:
  TreeWalk(const IndexTree& tree, const IndexOffsets& offsets, TreeSearch& search)
      : tree_(tree.arrays_), offsets_(offsets), search_(search), body_(search.body()) {}

  void run();

 private:
  static constexpr std::uint32_t kNode = std::numeric_limits<std::uint32_t>::max();
  /// Most levels of the body in one step.
  static constexpr int kMostLevels = 3;
  /// Longest node of the body beside a node of the scene, in lengths of the latter, by measurement:
  /// between long nodes and a single triangle a slab often tells at once that it is beyond the
  /// reach; between short nodes the same is asked again and again.
  static constexpr double kLargestRatio = 16.0;

  using Waiting = TreeBody::Waiting;

  void expand(const Waiting& pair);
  void meet(std::uint32_t place, std::uint32_t at, int levels);
  void ask_leaf(const Waiting& pair);
  void look(std::uint32_t place, const ByteFrame& frame, const ByteBoxes& boxes,
            BoxGaps& gaps) const;
  /// Returns whether the pair was surely asked about before, and remembers it. (A triangle is met
  /// in every leaf that holds it.) Forgetting one costs time only.
  bool was_met(std::uint32_t place, std::uint32_t triangle);

  const IndexArrays& tree_;
  IndexOffsets offsets_;
  TreeSearch& search_;
  TreeBody& body_;
};

}  // namespace camway::scene
