// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/threaded_guide.h"

#include <vector>

#include "daemon/correction/narrow/narrow_passage.h"

namespace camway::correction {

namespace {

using motion::SignedPose;

constexpr int kJoiningSamples = 1000;  // samples of trees between narrow places

/// Extends the guide from its end to `pose`, along a part of a way. Returns whether that succeeded.
bool extend(TreeResult& result, const SignedPose& pose, std::span<const geometry::Vec3> part_W,
            FreeSpace& space, TreeOptions options, const base::Deadline& deadline) {
  Guide& guide = result.guide;
  options.max_samples = kJoiningSamples;
  options.about_W = {space.center_W(motion::unsigned_pose(guide.back()))};
  options.about_W.insert(options.about_W.end(), part_W.begin(), part_W.end());
  options.about_W.push_back(space.center_W(motion::unsigned_pose(pose)));
  const TreeResult part = tree_way(space, guide.back(), pose, options, deadline);
  result.samples += part.samples;
  if (part.guide.empty()) return false;
  guide.insert(guide.end(), part.guide.begin() + 1, part.guide.end());
  return true;
}

}  // namespace

TreeResult threaded_guide(FreeSpace& space, std::span<const geometry::Vec3> way_W,
                          const SignedPose& from, const SignedPose& to, const TreeOptions& trees,
                          const base::Deadline& deadline) {
  const std::vector<NarrowPassage> passages =
      narrow_passages(space, way_W, from, to, trees.interpolated, trees.margin_m, deadline);
  if (passages.empty()) return {};
  TreeResult result{{from}};
  std::size_t begin = 0;
  const auto extend_to = [&](const SignedPose& pose, std::size_t last) {
    const std::size_t count = last < begin ? 0 : last + 1 - begin;
    return extend(result, pose, way_W.subspan(begin, count), space, trees, deadline);
  };
  for (const NarrowPassage& passage : passages) {
    if (!extend_to(passage.poses.front(), passage.first)) return {{}, result.samples};
    result.guide.insert(result.guide.end(), passage.poses.begin() + 1, passage.poses.end());
    begin = passage.last;
  }
  if (!extend_to(to, way_W.size() - 1)) return {{}, result.samples};
  return result;
}

}  // namespace camway::correction
