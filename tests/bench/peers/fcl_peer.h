// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>

#include "daemon/motion/body/camera.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::bench {

/// A check by the Flexible Collision Library: a hierarchy of oriented boxes over the scene, and the
/// near quadrilateral as a mesh of two triangles.
class FclPeer {
 public:
  /// Copies the triangles; `build` builds the hierarchy.
  explicit FclPeer(const scene::Mesh& mesh);
  ~FclPeer();
  FclPeer(const FclPeer&) = delete;
  FclPeer& operator=(const FclPeer&) = delete;

  /// Builds the hierarchy. Call once.
  void build();
  [[nodiscard]] std::size_t memory_bytes() const;

  void set_camera(const motion::Camera& camera);
  /// Returns whether the filled quadrilateral touches the scene. Stops at the first contact.
  [[nodiscard]] bool collides(const motion::Pose& pose) const;

  /// The library's own solvers for continuous collision between two poses.
  enum class Continuous { kNaive, kConservativeAdvancement };
  [[nodiscard]] bool collides_between(const motion::Pose& from, const motion::Pose& to,
                                      Continuous solver) const;

 private:
  struct Models;
  std::unique_ptr<Models> models_;
};

}  // namespace camway::bench
