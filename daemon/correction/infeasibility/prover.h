// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/correction/infeasibility/cage.h"
#include "daemon/correction/infeasibility/closed_surfaces.h"
#include "daemon/correction/infeasibility/separation.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/path/keyframe.h"
#include "daemon/scene/mesh/whole_mesh.h"

namespace camway::correction {

/// Proves that no path meets all keyframes, where a closed surface or a cage separates two of them.
/// Computes a proof when it is first asked for, since the closed surfaces of a large scene take
/// time.
///
/// Repaired keyframes prove nothing about a request, so proofs leave them out. The indices in a
/// proof are those of all keyframes.
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

  /// Returns whether a cage is proved to separate the two centres of the body, for this camera and
  /// all keyframes. That proves less than `cage`, and spares a search that finds no way.
  [[nodiscard]] bool is_caged_off(const geometry::Vec3& a_W, const geometry::Vec3& b_W) const;

  [[nodiscard]] bool has_proof() const { return separation_ || cage_; }
  /// At most one of the two is set.
  [[nodiscard]] const std::optional<Separation>& separation() const { return separation_; }
  [[nodiscard]] const std::optional<Cage>& cage() const { return cage_; }

 private:
  std::optional<Separation> separation_of_body();
  void look_for_cage();
  std::optional<Cage> cage_of_camera(double smallest, const std::vector<motion::Pose>& poses);
  const ClosedSurfaces& surfaces();

  const scene::WholeMesh& mesh_;
  const motion::Body& body_;
  const double smallest_;                     ///< least size of the camera, as a share of its own
  std::vector<std::size_t> as_asked_;         ///< indices of the keyframes that are not repaired
  std::vector<motion::Pose> poses_as_asked_;  ///< poses of these keyframes
  std::vector<motion::Pose> poses_;           ///< poses of all keyframes
  std::optional<ClosedSurfaces> surfaces_;    ///< closed surfaces of the scene, once computed
  bool looked_for_separation_ = false;
  bool looked_for_cage_ = false;
  std::optional<Separation> separation_;
  std::optional<Cage> cage_;
  /// Proof that there is no path but for a smaller camera, or for other keyframes.
  std::optional<Cage> cage_at_this_size_;
};

}  // namespace camway::correction
