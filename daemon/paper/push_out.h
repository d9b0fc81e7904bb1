// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include "daemon/motion/body/camera.h"
#include "daemon/scene/index/scene_index.h"

namespace camway::paper {

/// The paper's rule, evaluated at a colliding pose.
struct PushOutRule {
  std::array<bool, 4> bad{};  ///< whether the segment from the centre to this corner hits the scene
  std::array<double, 4> depth_m{};  ///< depths of bad corners; 0 for good ones
  geometry::Vec3 direction_W;       ///< sum of the vectors from the centre to the good corners

  [[nodiscard]] double largest_depth_m() const;
};

/// Evaluates good and bad corners, direction and depth at `pose` (Ptacek & Johnstone 2006, section
/// 4). The paper does not define the depth if neither edge next to a bad corner hits the scene; it
/// is then the distance from the corner to the nearest hit on its segment to the centre.
PushOutRule push_out_rule(const scene::SceneIndex& index, const motion::Corners& corners_C,
                          const motion::Pose& pose);

enum class PushOutOutcome {
  kFree,         ///< the near quadrilateral at `pose` keeps the margin
  kNoDirection,  ///< the rule has no direction: no corner is bad, all are, or the good ones cancel
  kCutOff,       ///< still colliding after `kMaxPushOutSteps`
};

struct PushOut {
  PushOutOutcome outcome;
  motion::Pose pose;
  int steps = 0;
};

/// Largest number of steps; the paper has no limit. Each step removes the deepest penetration seen,
/// so a pose that is not free by then is being pushed to and fro between obstacles.
inline constexpr int kMaxPushOutSteps = 40;

/// Least length of a step, as a share of the camera's radius, so that an exact touch, with depth
/// zero, still makes progress.
inline constexpr double kLeastStepShare = 0.02;

/// Moves `pose` by the rule, step by step, until it is free. The orientation is kept. Deviation:
/// the paper stops where the camera touches nothing any more, which may be arbitrarily near the
/// wall. Where the rule gives no direction any more, the last one is followed until `margin_m` is
/// clear, so that a neighbourhood of the new keyframe can be free.
PushOut push_out(const scene::SceneIndex& index, const motion::Corners& corners_C,
                 const motion::Pose& pose, double margin_m);

}  // namespace camway::paper
