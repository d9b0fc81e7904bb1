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

/// A voxel of a `VoxelGrid`: the one with index 0 begins at the origin, on each axis.
using Voxel = std::array<std::int32_t, 3>;

/// A cube of `size` voxels per edge, aligned as the nodes of OctoMap's tree are.
struct VoxelCube {
  Voxel min{};            ///< the voxel at its lowest corner
  std::int32_t size = 1;  ///< a power of two, 1 .. 65536

  /// Child `index` of the eight: bit 0 is the upper half in x, bit 1 in y, bit 2 in z. OctoMap
  /// numbers the children of a node in the same way.
  [[nodiscard]] VoxelCube child(unsigned index) const;
};

/// Which coordinate lies in which voxel, exactly as OctoMap's keys have it, and the boxes of voxels
/// rounded outwards. Pure arithmetic on the resolution; a value type, safe from any thread.
class VoxelGrid {
 public:
  /// OctoMap's keys have 16 bits per axis (Hornung et al. 2013, OctoMap 1.9, `OcTreeKey`); its key
  /// `k` is our voxel `k - 32768`.
  static constexpr std::int32_t kMinVoxel = -32768;
  static constexpr std::int32_t kMaxVoxel = 32767;

  /// The tree's root: everything that keys can name.
  static constexpr VoxelCube kRoot{{kMinVoxel, kMinVoxel, kMinVoxel}, 65536};

  /// How far a face is moved outwards, in units of half an ulp (2^-53) of `(|i| + 1)·resolution`
  /// for face `i`. OctoMap takes coordinate c to floor(fl(fl(1/r)·c)): two roundings, so that c may
  /// lie 2 units beyond the true face. Our face fl(i·r) is 1 unit off, and moving it rounds by 1
  /// more. The remaining 4 are for a caller's own rounding of a point near a face.
  static constexpr double kFaceErrorUnits = 8.0;

  /// Far beyond any use, and far inside what keeps products of three lengths normal doubles.
  static constexpr double kMinResolutionM = 1e-9;
  static constexpr double kMaxResolutionM = 1e9;

  /// Whether `resolution_m` is in [kMinResolutionM, kMaxResolutionM]; false for NaN.
  static bool valid_resolution(double resolution_m);

  /// Precondition: `valid_resolution(resolution_m)`.
  explicit VoxelGrid(double resolution_m);

  [[nodiscard]] double resolution_m() const { return resolution_m_; }

  /// The voxel that OctoMap maps `coordinate_m` to, or nothing if its keys cannot hold it (OctoMap
  /// itself overflows an int there) or if it is NaN.
  [[nodiscard]] std::optional<std::int32_t> voxel_of(double coordinate_m) const;
  [[nodiscard]] std::optional<Voxel> voxel_of(const geometry::Vec3& point) const;

  /// The closed box of `cube`, each face moved outwards by at most `face_error_m`: it holds every
  /// double that OctoMap maps into the cube, and the exact box.
  [[nodiscard]] geometry::Box box(const VoxelCube& cube) const;
  /// Its faces on one axis: the lower one of a cube that begins with voxel `index`, and the upper
  /// one of a cube that ends before it.
  [[nodiscard]] double low_face_m(std::int32_t index) const {
    return index * resolution_m_ - face_error_m(index);
  }
  [[nodiscard]] double high_face_m(std::int32_t index) const {
    return index * resolution_m_ + face_error_m(index);
  }

  /// Upper bound of how far the face at `index·resolution` is moved.
  [[nodiscard]] double face_error_m(std::int32_t index) const {
    return kFaceErrorUnits * geometry::kUnitRoundoff * (std::abs(index) + 1) * resolution_m_;
  }

 private:
  double resolution_m_;
  double voxels_per_m_;
};

/// The voxels whose boxes meet the interval [low_m, high_m] on one axis, or nothing if some of them
/// are beyond the keys.
struct VoxelRange {
  std::int32_t first = 0;
  std::int32_t last = 0;
};
std::optional<VoxelRange> voxels_touching(const VoxelGrid& grid, double low_m, double high_m);

/// Calls `visit` once for every voxel that `triangle` touches and that is `wanted` (faces, edges
/// and corners count, so a triangle in a face plane touches the voxels of both sides), in an order
/// that depends on the arguments only, until it returns false. Large triangles are followed octant
/// by octant, so that the cost follows the number of voxels touched and not the volume of the
/// triangle's box; of small ones all voxels about them are asked. What is not wanted, as it is
/// known already, costs less. Conservative: rounding may add a voxel that is
/// `VoxelGrid::kFaceErrorUnits` and the error of `triangle_touches_box` away, and never loses one.
/// Returns false if `visit` did, or if voxels beyond the keys would be touched (none is visited
/// then).
bool for_each_voxel_touched(const VoxelGrid& grid, const geometry::Triangle& triangle,
                            const std::function<bool(const Voxel&)>& wanted,
                            const std::function<bool(const Voxel&)>& visit);
/// All of them.
bool for_each_voxel_touched(const VoxelGrid& grid, const geometry::Triangle& triangle,
                            const std::function<bool(const Voxel&)>& visit);

}  // namespace camway::scene
