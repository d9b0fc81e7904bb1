// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>

#include "daemon/motion/body/camera.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::bench {

/// Embree: rays along the edges and diagonals of the near quadrilateral. The fastest check that
/// anyone could do with it, and not a proof of anything: it sees neither between samples nor what
/// passes through the quadrilateral's inside, and it computes in single precision.
class EmbreePeer {
 public:
  /// Hands the triangles over; `build` then builds. `threads` 0: the library's default.
  EmbreePeer(const scene::Mesh& mesh, unsigned threads);
  ~EmbreePeer();
  EmbreePeer(const EmbreePeer&) = delete;
  EmbreePeer& operator=(const EmbreePeer&) = delete;

  /// Commits the scene, in robust mode. Call once.
  void build();
  /// As the library reports it to a memory monitor, now and at most.
  [[nodiscard]] std::size_t memory_bytes() const;
  [[nodiscard]] std::size_t peak_memory_bytes() const;

  void set_camera(const motion::Camera& camera);
  /// One ray after the other, until one is stopped.
  [[nodiscard]] bool collides_by_rays(const motion::Pose& pose) const;
  /// All rays at once.
  [[nodiscard]] bool collides_by_packet(const motion::Pose& pose) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace camway::bench
