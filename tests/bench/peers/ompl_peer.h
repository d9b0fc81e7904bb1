// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/keyframe.h"
#include "daemon/motion/path/path.h"
#include "daemon/scene/mesh/mesh.h"
#include "tests/bench/peers/fcl_peer.h"

namespace camway::bench {

/// Poses between which the camera moves straight at constant rates.
struct PolylineWay {
  std::vector<motion::Pose> poses;
  std::vector<std::size_t> at_keyframe;  ///< index of each keyframe's pose, increasing
};

/// The Open Motion Planning Library with FCL, in the usual way: the space is SE(3); a state is
/// valid if FCL finds no contact; a motion is valid if its samples, at most `kStep_m` apart, are.
class OmplPeer {
 public:
  enum class Planner { kRrtConnect, kBitStar };

  /// Largest motion of a corner of the near quadrilateral between two samples.
  static constexpr double kStep_m = 0.01;
  /// Longest time to simplify a solution, for each pair of keyframes.
  static constexpr double kSimplify_s = 1.0;

  /// Refers to `fcl`, which must have the same camera. The library's random seed is set once in a
  /// process.
  OmplPeer(const FclPeer& fcl, const scene::Mesh& mesh, const motion::Camera& camera);

  /// Plans from keyframe to keyframe: by the straight motion, or if that collides by the planner's
  /// first solution, simplified. Returns nothing if `deadline_s` of processor time do not suffice
  /// for all pairs.
  [[nodiscard]] std::optional<PolylineWay> plan(std::span<const motion::Keyframe> keyframes,
                                                Planner planner, double deadline_s) const;

 private:
  const FclPeer& fcl_;
  const motion::Camera camera_;
  const geometry::Box bounds_;
};

/// Returns the motion between the poses as a path, one second from pose to pose. Rotations are
/// divided into segments so short that the path's points agree with the motion to a micrometre.
motion::Path straight_path(std::span<const motion::Pose> poses);

}  // namespace camway::bench
