// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <optional>

#include "daemon/geometry/rounding.h"
#include "daemon/geometry/types.h"

namespace camway::scene {

/// The index of a voxel of a `VoxelGrid`. On each axis voxel 0 begins at the origin.
using Voxel = std::array<std::int32_t, 3>;

/// A cube of `size` voxels per edge, aligned like the nodes of OctoMap's tree.
struct VoxelCube {
  Voxel min{};            ///< the voxel at its lowest corner
  std::int32_t size = 1;  ///< a power of two, 1 .. 65536

  /// Child `index` of the eight: bit 0 is the upper half in x, bit 1 in y, bit 2 in z. OctoMap
  /// numbers the children of a node in the same way.
  [[nodiscard]] VoxelCube child(unsigned index) const;
};

/// Maps coordinates to voxels exactly as OctoMap's keys do, and voxels to boxes that are rounded
/// outwards. Pure arithmetic on the resolution. A value type. Thread-safe.
class VoxelGrid {
 public:
  /// OctoMap's keys have 16 bits per axis (Hornung et al. 2013, OctoMap 1.9, `OcTreeKey`); its key
  /// `k` is our voxel `k - 32768`.
  static constexpr std::int32_t kMinVoxel = -32768;
  static constexpr std::int32_t kMaxVoxel = 32767;

  /// The root of OctoMap's tree: all voxels that have a key.
  static constexpr VoxelCube kRoot{{kMinVoxel, kMinVoxel, kMinVoxel}, 65536};

  /// How far face `i` is moved outwards, in units of half an ulp (2^-53) of `(|i| + 1)·resolution`.
  /// OctoMap maps coordinate c to floor(fl(fl(1/r)·c)): two roundings, so that c may lie 2 units
  /// beyond the true face. Our face fl(i·r) is 1 unit off, and moving it rounds by 1 more. The
  /// remaining 4 are for a caller's own rounding of a point near a face.
  static constexpr double kFaceErrorUnits = 8.0;

  /// Limits far beyond any use, within which products of three lengths are normal doubles.
  static constexpr double kMinResolutionM = 1e-9;
  static constexpr double kMaxResolutionM = 1e9;

  /// Whether `resolution_m` is in [kMinResolutionM, kMaxResolutionM]; false for NaN.
  static bool valid_resolution(double resolution_m);

  /// Requires `valid_resolution(resolution_m)`.
  explicit VoxelGrid(double resolution_m);

  [[nodiscard]] double resolution_m() const { return resolution_m_; }

  /// The voxel that OctoMap maps `coordinate_m` to. Returns nothing if it is NaN or if OctoMap's
  /// keys cannot hold the voxel (OctoMap itself overflows an int there).
  [[nodiscard]] std::optional<std::int32_t> voxel_of(double coordinate_m) const;
  [[nodiscard]] std::optional<Voxel> voxel_of(const geometry::Vec3& point) const;

  /// The closed box of `cube`, each face moved outwards by at most `face_error_m`. It contains the
  /// exact box and every double that OctoMap maps into the cube.
  [[nodiscard]] geometry::Box box(const VoxelCube& cube) const;
  /// Faces of such boxes on one axis: the lower face of a cube whose first voxel is `index`, and
  /// the upper face of a cube whose last voxel is `index - 1`.
  [[nodiscard]] double low_face_m(std::int32_t index) const {
    return index * resolution_m_ - face_error_m(index);
  }
  [[nodiscard]] double high_face_m(std::int32_t index) const {
    return index * resolution_m_ + face_error_m(index);
  }

  /// Upper bound of the distance by which the face at `index·resolution` is moved.
  [[nodiscard]] double face_error_m(std::int32_t index) const {
    return kFaceErrorUnits * geometry::kUnitRoundoff * (std::abs(index) + 1) * resolution_m_;
  }

 private:
  double resolution_m_;
  double voxels_per_m_;
};

/// A range of voxels on one axis; `voxels_touching` returns the voxels whose boxes meet the
/// interval [low_m, high_m], or nothing if any of them has no key.
struct VoxelRange {
  std::int32_t first = 0;
  std::int32_t last = 0;
};
std::optional<VoxelRange> voxels_touching(const VoxelGrid& grid, double low_m, double high_m);

/// Calls `visit` once for every voxel that `triangle` touches and that is `wanted`, until it
/// returns false. Faces, edges and corners count, so a triangle in a face plane touches the voxels
/// of both sides. The order depends on the arguments only. Large triangles are followed octant by
/// octant, so the cost depends on the number of touched voxels, not on the volume of the triangle's
/// box; for small ones every voxel of the box is tested. Voxels that are not wanted cost less.
///
/// Conservative: never misses a voxel; rounding may add one that is `VoxelGrid::kFaceErrorUnits`
/// and the error of `triangle_touches_box` away. Returns false if `visit` did, or, without visiting
/// any, if a touched voxel has no key.
bool for_each_voxel_touched(const VoxelGrid& grid, const geometry::Triangle& triangle,
                            const std::function<bool(const Voxel&)>& wanted,
                            const std::function<bool(const Voxel&)>& visit);
/// Visits all touched voxels.
bool for_each_voxel_touched(const VoxelGrid& grid, const geometry::Triangle& triangle,
                            const std::function<bool(const Voxel&)>& visit);

}  // namespace camway::scene
