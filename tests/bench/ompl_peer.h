// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/keyframe.h"
#include "daemon/motion/path/path.h"
#include "daemon/scene/mesh/mesh.h"
#include "tests/bench/fcl_peer.h"

namespace camway::bench {

/// Open Motion Planning Library as one would use it with FCL today: SE(3), a state is valid where
/// FCL finds no contact, a motion where that holds at samples no further apart than `kStep_m`.
class OmplPeer {
 public:
  enum class Planner { kRrtConnect, kBitStar };

  /// How far a corner of the near quadrilateral may move between two samples.
  static constexpr double kStep_m = 0.01;
  /// Spent on making what the planner found shorter, for each pair of keyframes at most.
  static constexpr double kSimplify_s = 1.0;

  /// Refers to `fcl`, which needs the same camera. The library's seed is fixed once in a process.
  OmplPeer(const FclPeer& fcl, const scene::Mesh& mesh, const motion::Camera& camera);

  /// From keyframe to keyframe: the straight motion, and where that collides the planner up to its
  /// first solution, which is then simplified. The poses between which the camera moves straight
  /// at constant rates; nothing if `deadline_s` of processor time did not suffice for all pairs.
  [[nodiscard]] std::optional<std::vector<motion::Pose>> plan(
      std::span<const motion::Keyframe> keyframes, Planner planner, double deadline_s) const;

 private:
  const FclPeer& fcl_;
  const motion::Camera camera_;
  const geometry::Box bounds_;
};

/// The same motion as a path that can be checked; a second from pose to pose. Turns are cut into
/// parts so short that where within them the camera is turned how far is the same to a micrometre.
motion::Path straight_path(std::span<const motion::Pose> poses);

}  // namespace camway::bench
