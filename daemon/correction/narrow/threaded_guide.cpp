// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/threaded_guide.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "daemon/correction/narrow/kept_passage.h"
#include "daemon/correction/narrow/narrow_passage.h"

namespace camway::correction {

namespace {

using motion::SignedPose;

constexpr int kJoiningSamples = 1000;  // samples of trees between narrow places

/// The points of a way from `begin` to before `end`.
struct WayPart {
  std::span<const geometry::Vec3> way_W;
  std::size_t begin = 0;
  std::size_t end = 0;

  [[nodiscard]] std::span<const geometry::Vec3> points_W() const {
    return way_W.subspan(begin, end - begin);
  }
  /// Of poses at equal shares of the way, as many at equal shares of the part.
  [[nodiscard]] std::vector<motion::Pose> part_of(std::span<const motion::Pose> poses) const {
    const auto last = static_cast<double>(way_W.size() - 1);
    const double begin_share = static_cast<double>(begin) / last;
    const double end_share = std::clamp(static_cast<double>(end) / last, begin_share, 1.0);
    std::vector<motion::Pose> part;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(poses.size() - 1);
      part.push_back(pose_at_share(poses, std::lerp(begin_share, end_share, share)));
    }
    return part;
  }
};

/// Extends the guide from its end to `pose`, along a part of a way. Returns whether that succeeded.
bool extend(TreeResult& result, const SignedPose& pose, const WayPart& way_part, FreeSpace& space,
            TreeOptions options, const base::Deadline& deadline) {
  Guide& guide = result.guide;
  const std::span<const geometry::Vec3> part_W = way_part.points_W();
  options.max_samples = kJoiningSamples;
  options.interpolated = way_part.part_of(options.interpolated);
  options.about_W = {space.center_W(motion::unsigned_pose(guide.back()))};
  options.about_W.insert(options.about_W.end(), part_W.begin(), part_W.end());
  options.about_W.push_back(space.center_W(motion::unsigned_pose(pose)));
  TreeResult part;
  if (!space.may_turn()) {
    part.guide =
        kept_way(space, options.about_W, guide.back(), pose, options.interpolated, options.margin_m)
            .value_or(Guide());
  }
  if (part.guide.empty()) part = tree_way(space, guide.back(), pose, options, deadline);
  result.samples += part.samples;
  if (part.guide.empty()) return false;
  guide.insert(guide.end(), part.guide.begin() + 1, part.guide.end());
  return true;
}

}  // namespace

TreeResult threaded_guide(FreeSpace& space, std::span<const geometry::Vec3> way_W,
                          const SignedPose& from, const SignedPose& to, const TreeOptions& trees,
                          const base::Deadline& deadline) {
  std::vector<NarrowPassage> passages;
  if (space.may_turn()) {
    passages = narrow_passages(space, way_W, from, to, trees.margin_m, deadline);
    if (passages.empty()) return {};
  } else {
    auto kept = kept_passages(space, way_W, from, trees.interpolated, trees.margin_m, deadline);
    if (!kept) return {};
    passages = *std::move(kept);
  }
  TreeResult result{{from}};
  std::size_t begin = 0;
  const auto extend_to = [&](const SignedPose& pose, std::size_t last) {
    const WayPart part{way_W, begin, std::max(begin, last + 1)};
    return extend(result, pose, part, space, trees, deadline);
  };
  for (const NarrowPassage& passage : passages) {
    if (!extend_to(passage.poses.front(), passage.first)) return {{}, result.samples};
    result.guide.insert(result.guide.end(), passage.poses.begin() + 1, passage.poses.end());
    begin = passage.last;
  }
  if (!extend_to(to, way_W.size() - 1)) return {{}, result.samples};
  // The way of the small ball may lead far from the path for no reason of the body.
  if (!space.may_turn()) result.guide = shortened(result.guide, space, 0.1 * trees.margin_m);
  return result;
}

}  // namespace camway::correction
