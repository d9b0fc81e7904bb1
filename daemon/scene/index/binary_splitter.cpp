// SPDX-License-Identifier: MIT
#include "daemon/scene/index/binary_splitter.h"

#include <utility>

#include "daemon/scene/index/index_node.h"

namespace camway::scene {
namespace {

/// Cost of one more split for a query, in tests of entries.
constexpr double kSplitCost = 1.0;

}  // namespace

bool pays(const BinSplit& split, const IndexPart& part) {
  return split.cost_m2 <
         (static_cast<double>(part.entries.size()) - kSplitCost) * half_area_m2(part.box);
}

std::vector<IndexPart> BinarySplitter::split(IndexPart& part) const {
  if (!may_split(part) || part.depth >= options_.max_depth) return {};
  std::vector<IndexPart> parts;
  parts.reserve(kNodeWidth);
  parts.push_back(std::move(part));
  while (parts.size() < kNodeWidth) {
    const auto costliest = std::max_element(
        parts.begin(), parts.end(),
        [&](const IndexPart& a, const IndexPart& b) { return urgency(a) < urgency(b); });
    if (!may_split(*costliest)) break;
    std::optional<IndexPart> upper = split_in_two(*costliest);
    costliest->is_final = !upper;
    if (upper) parts.insert(costliest + 1, std::move(*upper));
  }
  if (parts.size() == 1) {
    part = std::move(parts.front());
    return {};
  }
  for (IndexPart& child : parts) ++child.depth;
  return parts;
}

bool BinarySplitter::may_split(const IndexPart& part) const {
  return !part.is_final && part.entries.size() > options_.threshold;
}

double BinarySplitter::urgency(const IndexPart& part) const {
  if (!may_split(part)) return -1.0;
  return half_area_m2(part.box) * static_cast<double>(part.entries.size());
}

}  // namespace camway::scene
