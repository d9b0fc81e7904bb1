// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include "daemon/motion/body/camera.h"
#include "daemon/scene/index/scene_index.h"

namespace camway::correction {

/// One reading of the seed's rule at a colliding pose.
struct PushOutRule {
  std::array<bool, 4> bad{};        ///< the segment from the centre to this corner hits the scene
  std::array<double, 4> depth_m{};  ///< of bad corners; 0 for good ones
  geometry::Vec3 direction_W;       ///< sum of the vectors from the centre to the good corners

  [[nodiscard]] double largest_depth_m() const;
};

/// Good and bad corners, direction and depth at `pose` (Ptacek & Johnstone 2006, section 4).
/// Where neither edge next to a bad corner hits anything, the paper says nothing; the distance from
/// the corner to the nearest hit on its own segment to the centre is its depth then.
PushOutRule push_out_rule(const scene::SceneIndex& index, const motion::Corners& corners_C,
                          const motion::Pose& pose);

enum class PushOutOutcome {
  kFree,         ///< nothing is within the margin of the near quadrilateral at `pose`
  kNoDirection,  ///< the rule gives none: no corner is bad, all are, or the good ones cancel
  kCutOff,       ///< still colliding after `kMaxPushOutSteps`
};

struct PushOut {
  PushOutOutcome outcome;
  motion::Pose pose;
  int steps = 0;
};

/// The paper has no bound. Each step removes the deepest penetration seen, so that a pose that is
/// not free after this many is being pushed to and fro between obstacles.
inline constexpr int kMaxPushOutSteps = 40;

/// A step is at least this share of the camera's radius, so that touching exactly, with depth zero,
/// still makes progress.
inline constexpr double kLeastStepShare = 0.02;

/// Moves `pose` by the rule, step after step, until it is free. The orientation is kept.
/// Deviation: the paper stops where nothing is touched any more, which may be a hair's breadth from
/// the wall; where the rule has nothing left to say, the last direction is followed until
/// `margin_m` is clear, so that a neighbourhood of the new keyframe can be free and not just
/// itself.
PushOut push_out(const scene::SceneIndex& index, const motion::Corners& corners_C,
                 const motion::Pose& pose, double margin_m);

}  // namespace camway::correction
