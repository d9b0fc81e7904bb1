// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/correction/infeasibility/cage.h"
#include "daemon/correction/infeasibility/separation.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/path/keyframe.h"
#include "daemon/scene/mesh/whole_mesh.h"

namespace camway::correction {

/// Proves that no path meets all keyframes, if a closed surface or a cage separates two of them.
/// Each proof is computed at the first call that needs it, because the closed surfaces of a large
/// scene take time.
///
/// A repaired keyframe proves nothing about a request, so proofs use the other keyframes only. An
/// index in a proof counts all keyframes.
/// Not thread-safe.
class Prover {
 public:
  /// Refers to `mesh` and `body`, which must outlive it. A proof holds for every size of the camera
  /// down to 1 - `max_shrink`. [Limit: 0 <= max_shrink < 1]
  Prover(const scene::WholeMesh& mesh, const motion::Body& body,
         const std::vector<motion::Keyframe>& keyframes, double max_shrink);

  /// Returns whether a closed surface separates two keyframes; computed by the first call.
  bool is_separated();

  /// Returns whether a cage separates two keyframes; computed by the first call. False if the body
  /// is not a camera, or if a closed surface separates keyframes.
  bool is_caged();

  /// Returns whether a cage separates two places of the body's centre, for the camera at its own
  /// size and all keyframes, repaired ones included. That proves less than `cage`, but saves a
  /// search that would find no way. False before the first call of `is_caged`.
  [[nodiscard]] bool is_caged_off(const geometry::Vec3& a_W, const geometry::Vec3& b_W) const;

  [[nodiscard]] bool has_proof() const { return separation_ || cage_; }
  /// The proofs found so far; at most one is set.
  [[nodiscard]] const std::optional<Separation>& separation() const { return separation_; }
  [[nodiscard]] const std::optional<Cage>& cage() const { return cage_; }

 private:
  std::optional<Separation> separation_of_body();
  void look_for_cage();
  std::optional<Cage> cage_of_camera(double smallest, const std::vector<motion::Pose>& poses);

  const scene::WholeMesh& mesh_;
  const motion::Body& body_;
  const double smallest_;                     ///< least size of the camera, as a share of its own
  std::vector<std::size_t> as_asked_;         ///< indices of the keyframes that are not repaired
  std::vector<motion::Pose> poses_as_asked_;  ///< poses of these keyframes
  std::vector<motion::Pose> poses_;           ///< poses of all keyframes
  bool looked_for_separation_ = false;
  bool looked_for_cage_ = false;
  std::optional<Separation> separation_;
  std::optional<Cage> cage_;
  /// A cage that a smaller camera may leave, or that separates repaired keyframes.
  std::optional<Cage> cage_at_this_size_;
};

}  // namespace camway::correction
