// SPDX-License-Identifier: MIT
#include "daemon/correction/search/threaded_guide.h"

#include <vector>

#include "daemon/correction/search/narrow_passage.h"

namespace camway::correction {

namespace {

using motion::SignedPose;

constexpr int kJoiningSamples = 1000;  // samples of trees between narrow places

/// Extends the guide from its end to `pose`, along a part of a way. Returns whether that succeeded.
bool extend(Guide& guide, const SignedPose& pose, std::span<const geometry::Vec3> part_W,
            FreeSpace& space, TreeOptions options, const base::Deadline& deadline) {
  options.max_samples = kJoiningSamples;
  options.about_W = {space.center_W(motion::unsigned_pose(guide.back()))};
  options.about_W.insert(options.about_W.end(), part_W.begin(), part_W.end());
  options.about_W.push_back(space.center_W(motion::unsigned_pose(pose)));
  const Guide part = tree_way(space, guide.back(), pose, options, deadline);
  if (part.empty()) return false;
  guide.insert(guide.end(), part.begin() + 1, part.end());
  return true;
}

}  // namespace

Guide threaded_guide(FreeSpace& space, std::span<const geometry::Vec3> way_W,
                     const SignedPose& from, const SignedPose& to, const TreeOptions& trees,
                     const base::Deadline& deadline) {
  const std::vector<NarrowPassage> passages =
      narrow_passages(space, way_W, from, to, trees.margin_m, deadline);
  if (passages.empty()) return {};
  Guide guide = {from};
  std::size_t begin = 0;
  const auto part_until = [&](std::size_t last) {
    return last < begin ? std::span<const geometry::Vec3>()
                        : way_W.subspan(begin, last + 1 - begin);
  };
  for (const NarrowPassage& passage : passages) {
    if (!extend(guide, passage.before, part_until(passage.first), space, trees, deadline)) {
      return {};
    }
    guide.push_back(passage.after);
    begin = passage.last;
  }
  const bool arrives = extend(guide, to, part_until(way_W.size() - 1), space, trees, deadline);
  return arrives ? guide : Guide{};
}

}  // namespace camway::correction
