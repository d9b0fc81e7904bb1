// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/scene/mesh/mesh.h"
#include "daemon/scene/mesh/placement.h"
#include "daemon/scene/mesh/resource_limit.h"
#include "daemon/scene/voxels/block_map.h"
#include "daemon/scene/voxels/voxel_faces.h"
#include "daemon/scene/voxels/voxel_set.h"

namespace camway::scene {

/// The state that unknown voxels of a map count as.
enum class UnknownSpace : std::uint8_t {
  kFree,
  /// All unknown voxels in the box of the known ones and in a layer around it count as occupied, so
  /// that no body inside can leave the known free space. Beyond the layer the map says nothing.
  kOccupied,
};

/// The reliability of scans in OctoMap's sensor model, which counts a voxel as occupied from a
/// probability of one half on.
struct SensorModel {
  double hit_probability = 0.7;   ///< occupied, when a point lies in it [Limit: 0.5 < value < 1]
  double miss_probability = 0.4;  ///< occupied, when a ray passes it [Limit: 0 < value < 0.5]
  double least_probability = 0.1192;  ///< clamping limit of free voxels [Limit: 0 < value < 0.5]
  double most_probability = 0.971;    ///< clamping limit of occupied ones [Limit: 0.5 < value < 1]
  /// Points farther away only show that the ray is free up to this range. [Limit: 0 < value]
  double max_range_m = std::numeric_limits<double>::infinity();

  bool operator==(const SensorModel&) const = default;
};

/// Names the first invalid number and says why; empty if all are valid.
std::string fault_in(const SensorModel& sensor);

/// Largest size of a map.
struct VoxelMapLimits {
  /// Limit of the occupied voxels, of the free voxels and, where the unknown counts as occupied, of
  /// all voxels in the box of both and its layer. [Limit: 1 <= value]
  std::uint64_t voxels = std::uint64_t{1} << 27;
  std::size_t triangles = 8'000'000;  ///< limit of its faces [Limit: 12 <= value]

  bool operator==(const VoxelMapLimits&) const = default;
};

struct VoxelMapResult;

/// For each voxel of a block the log-odds that it is occupied, as OctoMap computes them; x runs
/// fastest, then y. 0 where nothing is known.
using Beliefs = std::array<float, 512>;

/// The new contents of a block after a scan.
struct ScannedBlock {
  std::uint64_t key = 0;  ///< `BlockKey` of the block
  VoxelSet::Bits occupied{};
  VoxelSet::Bits free{};
  std::shared_ptr<const Beliefs> beliefs;  ///< null if the block was never scanned
};

/// An occupancy map: a solid of voxels, and what is known of the space around it. Its faces are
/// an ordinary mesh, but lie only between solid voxels and others. So a body deep inside the solid
/// meets no face, and callers must ask for the inside separately. Immutable. Thread-safe.
class VoxelMap {
 public:
  /// Builds a map; a voxel in both sets is occupied. Fails if the resolution is invalid or there
  /// are too many voxels. Too many triangles are no failure: then `faces` is empty. Requires voxels
  /// within the limits of `VoxelGrid` and a sensor without `fault_in`.
  static VoxelMapResult build(double resolution_m, VoxelSet occupied, VoxelSet free,
                              UnknownSpace unknown, const VoxelMapLimits& limits = {},
                              const SensorModel& sensor = {});

  /// Returns the map with `blocks` in place of its own. The result is equal to a map built from the
  /// same voxels, but shares the unchanged parts with this one. The cost depends on the change.
  /// Fails as `build` does. Requires that `blocks` leave no voxel unknown that is known here.
  [[nodiscard]] VoxelMapResult with(std::span<const ScannedBlock> blocks) const;

  /// Returns the blocks that differ from those of `before`, in order of their keys. `before.with`
  /// of them is equal to this map if the resolution, the limits, the sensor and the state of
  /// unknown space are equal, and if no voxel is unknown here that is known there. The cost depends
  /// on the changes since one of the two maps was made from the other.
  [[nodiscard]] std::vector<ScannedBlock> blocks_changed_since(const VoxelMap& before) const;

  [[nodiscard]] double resolution_m() const { return resolution_m_; }
  [[nodiscard]] UnknownSpace unknown() const { return unknown_; }
  [[nodiscard]] const VoxelMapLimits& limits() const { return limits_; }
  [[nodiscard]] const SensorModel& sensor() const { return sensor_; }
  /// Log-odds of a block; null if it was never scanned.
  [[nodiscard]] const Beliefs* beliefs(std::uint64_t key) const {
    const std::shared_ptr<const Beliefs>* const found = beliefs_.find(key);
    return found != nullptr ? found->get() : nullptr;
  }
  /// Number of blocks with log-odds.
  [[nodiscard]] std::size_t scanned_blocks() const { return beliefs_.size(); }
  [[nodiscard]] const VoxelSet& occupied() const { return occupied_; }
  [[nodiscard]] const VoxelSet& free() const { return free_; }
  /// The voxels that no body may enter.
  [[nodiscard]] const VoxelSet& solid() const {
    return unknown_ == UnknownSpace::kFree ? occupied_ : solid_;
  }
  /// Memory of the map without its faces.
  [[nodiscard]] std::uint64_t memory_bytes() const;
  /// The part of `memory_bytes` that is not shared with `other`.
  [[nodiscard]] std::uint64_t memory_bytes_beside(const VoxelMap& other) const;

  /// The faces of the solid in the frame of the map; nothing if they exceed the limit of triangles.
  [[nodiscard]] const std::optional<VoxelFaces>& faces() const { return faces_; }

  /// Whether a point of the solid is, or may be, within `error_m` of `point_O` on every axis. True
  /// for a point that is not finite.
  [[nodiscard]] bool is_solid_near(const geometry::Vec3& point_O, double error_m) const;

 private:
  VoxelMap(double resolution_m, VoxelSet occupied, VoxelSet free, UnknownSpace unknown);

  [[nodiscard]] std::string fault() const;
  // For maps whose unknown space is occupied:
  [[nodiscard]] VoxelSet::Range box() const;
  void fill(std::uint64_t key);
  void fill_beyond(const VoxelSet::Range& before);

  double resolution_m_;
  UnknownSpace unknown_;
  VoxelSet occupied_;
  VoxelSet free_;
  // Used only if unknown space is occupied.
  VoxelSet solid_;
  VoxelSet::Range known_ = VoxelSet::kNoVoxels;  ///< contains what is occupied or free
  VoxelMapLimits limits_;
  SensorModel sensor_;
  BlockMap<std::shared_ptr<const Beliefs>> beliefs_;
  std::optional<VoxelFaces> faces_;
};

/// A map, or the reason why there is none.
struct VoxelMapResult {
  std::shared_ptr<const VoxelMap> map;
  std::string error;           ///< empty exactly when `map` is set
  Limit limit = Limit::kNone;  ///< limit that the error is about
};

/// An occupancy map with its placement in the world.
struct PlacedVoxelMap {
  std::shared_ptr<const VoxelMap> map;
  Placement placement;
  geometry::Box bounds_W;  ///< bounds of its placed mesh

  /// Whether `point_W` is inside the solid, or so near to it, within `bounds_W`, that rounding
  /// hides the difference. True for a point that is not finite.
  [[nodiscard]] bool holds(const geometry::Vec3& point_W) const;
};

/// The solids of a scene: its objects that have an inside. Immutable. Thread-safe.
class SceneSolids {
 public:
  explicit SceneSolids(std::vector<PlacedVoxelMap> maps) : maps_(std::move(maps)) {}

  /// Whether `point_W` is inside one of the solids. A connected body that touches no triangle of
  /// the scene is inside with all of its points or with none.
  [[nodiscard]] bool hold(const geometry::Vec3& point_W) const;

 private:
  std::vector<PlacedVoxelMap> maps_;
};

}  // namespace camway::scene
