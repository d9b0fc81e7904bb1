// SPDX-License-Identifier: MIT
#include "daemon/scene/index/tree_walk.h"

#include <algorithm>
#include <bit>

namespace camway::scene {

namespace {

/// Half the longest side of the boxes of a frame: about the size of a child.
double child_size_m(const ByteFrame& frame) {
  const int largest = std::max({frame.exponent[0], frame.exponent[1], frame.exponent[2]});
  return 0.5 * ByteFrame::kSteps * power_of_two(largest);
}

}  // namespace

void TreeWalk::run() {
  if (tree_.nodes.empty()) return;
  std::vector<Waiting>& waiting = body_.waiting_;
  waiting.clear();
  body_.met_.fill({kNode, kNode});
  waiting.push_back({0.0, TreeBody::kRoot, 0, kNode});
  while (!waiting.empty()) {
    const Waiting pair = waiting.back();
    waiting.pop_back();
    if (search_.is_beyond(body_.node_at(pair.place), pair.squared_m2)) continue;
    if (pair.leaf == kNode) {
      expand(pair);
    } else {
      ask_leaf(pair);
    }
    if (search_.is_done()) return;
  }
}

void TreeWalk::look(std::uint32_t place, const ByteFrame& frame, const ByteBoxes& boxes,
                    BoxGaps& gaps) const {
  const TreeBody::Placed& placed = body_.placed(place);
  const double squared_reach_m2 = search_.squared_reach_m2(body_.node(placed.node));
  FramedBox framed;
  put_in_frame(frame, placed.sides, &placed.oblique, framed);
  box_gaps(framed, boxes, squared_reach_m2, gaps);
}

void TreeWalk::expand(const Waiting& pair) {
  std::vector<Waiting>& waiting = body_.waiting_;
  const auto before = static_cast<std::ptrdiff_t>(waiting.size());
  meet(pair.place, pair.node, kMostLevels);
  // The nearest on top; among equals the first.
  std::ranges::reverse(waiting.begin() + before, waiting.end());
  std::stable_sort(waiting.begin() + before, waiting.end(),
                   [](const Waiting& a, const Waiting& b) { return a.squared_m2 > b.squared_m2; });
}

void TreeWalk::meet(std::uint32_t place, std::uint32_t at, int levels) {
  const IndexNode& node = tree_.nodes[at];
  BoxGaps gaps;
  look(place, node.frame, node.boxes, gaps);
  unsigned near = gaps.near & ((1U << node.child_count) - 1U);
  if (near == 0) return;
  if (levels > 0 && !body_.node_at(place).is_leaf() &&
      body_.placed(place).size_m > kLargestRatio * child_size_m(node.frame)) {
    const std::uint32_t first = body_.children_of(place);
    meet(first, at, levels - 1);
    meet(first + 1, at, levels - 1);
    return;
  }
  for (; near != 0; near &= near - 1U) {
    const auto slot = static_cast<std::uint32_t>(std::countr_zero(near));
    const double squared_m2 = static_cast<double>(gaps.squared[slot]) * gaps.square_m2;
    const bool is_leaf = slot >= node.node_count;
    body_.waiting_.push_back({squared_m2, place, is_leaf ? at : node.first_node + slot,
                              is_leaf ? node.first_leaf + slot - node.node_count : kNode});
  }
}

void TreeWalk::ask_leaf(const Waiting& pair) {
  const std::uint32_t begin = tree_.leaf_begin[pair.leaf];
  const std::uint32_t end = tree_.leaf_begin[pair.leaf + 1];
  std::vector<TreeBody::Near>& entries = body_.entries_;
  entries.clear();
  BoxGaps gaps;
  for (std::uint32_t first = begin - begin % kNodeWidth; first < end; first += kNodeWidth) {
    look(pair.place, tree_.nodes[pair.node].frame, tree_.boxes[first / kNodeWidth], gaps);
    // A group of eight boxes may belong to several leaves.
    unsigned near = gaps.near;
    if (first < begin) near &= 0xFFU << (begin - first);
    if (end - first < kNodeWidth) near &= (1U << (end - first)) - 1U;
    for (; near != 0; near &= near - 1U) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(near));
      const std::uint32_t triangle = offsets_.entry + tree_.references[first + i];
      entries.push_back({static_cast<double>(gaps.squared[i]) * gaps.square_m2, triangle});
    }
  }
  std::ranges::sort(entries, [](const TreeBody::Near& a, const TreeBody::Near& b) {
    return a.squared_m2 < b.squared_m2 || (a.squared_m2 == b.squared_m2 && a.triangle < b.triangle);
  });
  const std::uint32_t node = body_.placed(pair.place).node;
  for (const TreeBody::Near& entry : entries) {
    // A leaf has the box of the part of a triangle in its cell: if it is beyond the reach, another
    // part, in another leaf, may not be.
    if (search_.is_beyond(body_.node(node), entry.squared_m2)) continue;
    if (was_met(pair.place, entry.triangle)) continue;
    search_.ask(node, entry.triangle);
    if (search_.is_done()) return;
  }
}

bool TreeWalk::was_met(std::uint32_t place, std::uint32_t triangle) {
  TreeBody::Met& slot = body_.met_[(31U * place + triangle) % body_.met_.size()];
  if (slot.place == place && slot.triangle == triangle) return true;
  slot = {place, triangle};
  return false;
}

}  // namespace camway::scene
