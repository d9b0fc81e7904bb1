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

/// What the voxels of a map count as of which nothing is known.
enum class UnknownSpace : std::uint8_t {
  kFree,
  /// All within the box of what is known, and a layer about it: so nothing that is in the map can
  /// leave what is known to be free. Beyond that layer the map says nothing.
  kOccupied,
};

/// How far a scan is to be believed, as OctoMap has it: a voxel is occupied if it is so with a
/// probability of a half or more.
struct SensorModel {
  double hit_probability = 0.7;       ///< of a voxel that was seen [Limit: 0.5 < value < 1]
  double miss_probability = 0.4;      ///< of one that was seen through [Limit: 0 < value < 0.5]
  double least_probability = 0.1192;  ///< nothing is surer to be free [Limit: 0 < value < 0.5]
  double most_probability = 0.971;    ///< nor occupied [Limit: 0.5 < value < 1]
  /// Points further away say only that there is nothing up to there. [Limit: 0 < value]
  double max_range_m = std::numeric_limits<double>::infinity();
};

/// Which of its numbers cannot be, or an empty text.
std::string fault_in(const SensorModel& sensor);

/// How large a map may be.
struct VoxelMapLimits {
  /// That are known to be occupied, or known to be free, or in the box of both where the unknown
  /// counts as occupied. [Limit: 1 <= value]
  std::uint64_t voxels = std::uint64_t{1} << 27;
  std::size_t triangles = 8'000'000;  ///< of its faces [Limit: 12 <= value]
};

struct VoxelMapResult;

/// What a map believes of the voxels of a block: the logarithm of the odds that it is occupied, as
/// OctoMap computes it; x runs fastest, then y. 0 where nothing is known.
using Beliefs = std::array<float, 512>;

/// What a scan makes of a block.
struct ScannedBlock {
  std::uint64_t key = 0;  ///< as `BlockKey` has it
  VoxelSet::Bits occupied{};
  VoxelSet::Bits free{};
  std::shared_ptr<const Beliefs> beliefs;
};

/// An occupancy map as a thing in a scene: a solid that consists of voxels, and what is known of
/// the space about them. Its faces are an ordinary mesh, but only those between solid voxels and
/// others; so what is inside must be asked for apart, or a body that is there would meet nothing.
/// Immutable; safe from any thread.
class VoxelMap {
 public:
  /// A voxel in both sets is occupied. One of too many voxels is refused; of its faces, `skin`
  /// knows the limit. Preconditions: within the limits of `VoxelGrid`; the sensor has no
  /// `fault_in`.
  static VoxelMapResult build(double resolution_m, VoxelSet occupied, VoxelSet free,
                              UnknownSpace unknown, const VoxelMapLimits& limits = {},
                              const SensorModel& sensor = {});

  /// The map with these blocks in the place of its own: equal in everything to one that was built
  /// of the same voxels, but it shares what did not change, and costs what did. What is known stays
  /// known: precondition.
  [[nodiscard]] VoxelMapResult with(std::span<const ScannedBlock> blocks) const;

  [[nodiscard]] double resolution_m() const { return resolution_m_; }
  [[nodiscard]] UnknownSpace unknown() const { return unknown_; }
  [[nodiscard]] const VoxelMapLimits& limits() const { return limits_; }
  [[nodiscard]] const SensorModel& sensor() const { return sensor_; }
  /// Of a block; null if it was never scanned.
  [[nodiscard]] const Beliefs* beliefs(std::uint64_t key) const {
    const std::shared_ptr<const Beliefs>* const found = beliefs_.find(key);
    return found != nullptr ? found->get() : nullptr;
  }
  [[nodiscard]] const VoxelSet& occupied() const { return occupied_; }
  [[nodiscard]] const VoxelSet& free() const { return free_; }
  /// The voxels that nothing may be in.
  [[nodiscard]] const VoxelSet& solid() const {
    return unknown_ == UnknownSpace::kFree ? occupied_ : solid_;
  }
  /// Without its faces.
  [[nodiscard]] std::uint64_t memory_bytes() const;
  /// The same, without what it shares with `other`.
  [[nodiscard]] std::uint64_t memory_bytes_beside(const VoxelMap& other) const;

  /// The faces of the solid, in the frame of the map; nothing if there are too many.
  [[nodiscard]] const std::optional<VoxelSkin>& skin() const { return skin_; }

  /// Whether a point of the solid is within `error_m` of `point_O` on every axis, or may be. True
  /// for what is not finite.
  [[nodiscard]] bool is_solid_near(const geometry::Vec3& point_O, double error_m) const;

 private:
  VoxelMap(double resolution_m, VoxelSet occupied, VoxelSet free, UnknownSpace unknown);

  [[nodiscard]] std::string fault() const;
  // Where the unknown is occupied:
  [[nodiscard]] VoxelSet::Range box() const;
  void fill(std::uint64_t key);
  void fill_beyond(const VoxelSet::Range& before);

  double resolution_m_;
  UnknownSpace unknown_;
  VoxelSet occupied_;
  VoxelSet free_;
  // Both where the unknown is occupied.
  VoxelSet solid_;
  VoxelSet::Range known_ = VoxelSet::kNoVoxels;  ///< holds what is occupied or free
  VoxelMapLimits limits_;
  SensorModel sensor_;
  BlockMap<std::shared_ptr<const Beliefs>> beliefs_;
  std::optional<VoxelSkin> skin_;
};

/// A map, or why there is none.
struct VoxelMapResult {
  std::shared_ptr<const VoxelMap> map;
  std::string error;           ///< empty exactly when `map` is set
  Limit limit = Limit::kNone;  ///< that the error is about
};

/// A map in its place.
struct PlacedVoxelMap {
  std::shared_ptr<const VoxelMap> map;
  Placement placement;
  geometry::Box bounds_W;  ///< of its mesh

  /// Whether `point_W` is inside the solid, or so near to it that rounding hides the difference.
  [[nodiscard]] bool holds(const geometry::Vec3& point_W) const;
};

/// What of a scene has an inside. Immutable; safe from any thread.
class SceneSolids {
 public:
  explicit SceneSolids(std::vector<PlacedVoxelMap> maps) : maps_(std::move(maps)) {}

  /// Whether `point_W` is inside one of them. Something that is connected and touches no triangle
  /// of the scene is inside with all of its points or with none.
  [[nodiscard]] bool hold(const geometry::Vec3& point_W) const;

 private:
  std::vector<PlacedVoxelMap> maps_;
};

}  // namespace camway::scene
