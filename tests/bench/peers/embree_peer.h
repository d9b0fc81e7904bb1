// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>

#include "daemon/motion/body/camera.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::bench {

/// A check by Embree: rays along the edges and diagonals of the near quadrilateral. It is the
/// fastest possible check with Embree, and no proof: it misses collisions between samples and
/// objects inside the quadrilateral, and computes in single precision.
class EmbreePeer {
 public:
  /// Copies the triangles; `build` builds the index. `threads` 0: the library's default.
  EmbreePeer(const scene::Mesh& mesh, unsigned threads);
  ~EmbreePeer();
  EmbreePeer(const EmbreePeer&) = delete;
  EmbreePeer& operator=(const EmbreePeer&) = delete;

  /// Commits the scene, in robust mode. Call once.
  void build();
  /// Return the present and the largest memory that the library has reported to a memory monitor.
  [[nodiscard]] std::size_t memory_bytes() const;
  [[nodiscard]] std::size_t peak_memory_bytes() const;

  void set_camera(const motion::Camera& camera);
  /// Traces the rays in turn until one hits.
  [[nodiscard]] bool collides_by_rays(const motion::Pose& pose) const;
  /// Traces all rays as one packet.
  [[nodiscard]] bool collides_by_packet(const motion::Pose& pose) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace camway::bench
