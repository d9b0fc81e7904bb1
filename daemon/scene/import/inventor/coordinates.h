// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/scene/import/inventor/placement.h"
#include "daemon/scene/import/readers/mesh_collector.h"

class SbVec3f;
class SbVec4f;
class SoCallbackAction;
class SoNode;

namespace camway::scene::inventor {

/// The coordinates that a shape of vertices uses: with or without weights, in memory of Coin's that
/// stays valid during a callback.
class Coordinates {
 public:
  /// Those of the shape itself (VertexProperty, or the `coord` of VRML 97), or else those of the
  /// node before it.
  Coordinates(SoCallbackAction& action, const SoNode& shape);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// (w x, w y, w z, w). Requires i < size().
  [[nodiscard]] std::array<double, 4> weighted(std::size_t i) const;
  [[nodiscard]] Point point(std::size_t i) const;

 private:
  void take(const SbVec3f* points, int count);

  const SbVec3f* plain_ = nullptr;
  const SbVec4f* weighted_ = nullptr;
  std::size_t size_ = 0;
};

/// Adds the vertices of a shape to the mesh when a face first uses them: many shapes may share one
/// long list.
class ShapeVertices {
 public:
  explicit ShapeVertices(mesh_readers::MeshCollector& mesh) : mesh_(mesh) {}

  /// Begins a shape. Both must outlive its calls of `vertex`.
  void begin(const Coordinates& coordinates, const Placement& placement);
  /// Index in the mesh of a coordinate; `kNoVertex` if there is none.
  std::uint32_t vertex(std::int64_t number);
  /// Largest magnitudes of the coordinates that were used since `begin`, before their placement.
  [[nodiscard]] const Point& largest() const { return largest_; }

 private:
  struct Known {
    std::uint64_t shape = 0;  ///< number of the shape that used it last
    std::uint32_t index = 0;
  };

  mesh_readers::MeshCollector& mesh_;
  const Coordinates* coordinates_ = nullptr;
  const Placement* placement_ = nullptr;
  std::vector<Known> known_;
  std::uint64_t shape_ = 0;
  Point largest_{};
};

}  // namespace camway::scene::inventor
