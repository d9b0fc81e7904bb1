// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>

#include "daemon/geometry/types.h"
#include "daemon/scene/mesh/mesh.h"
#include "daemon/scene/mesh/resource_limit.h"
#include "daemon/scene/mirror/box_costs.h"
#include "daemon/scene/mirror/voxel_tree.h"
#include "daemon/scene/voxels/voxel_grid.h"
#include "daemon/scene/voxels/voxel_map.h"

namespace camway::scene {

struct OccupancyStatistics {
  double resolution_m = 0.0;
  std::uint64_t occupied_voxels = 0;  ///< at full resolution: a cube counts as all its voxels
  std::uint64_t nodes = 0;
  std::uint64_t memory_bytes = 0;
};

/// The OctoMap mirror of an object (Hornung et al. 2013, "OctoMap"): its occupied voxels and the
/// cubes that OctoMap's tree makes of them, in a form that is faster to search (`VoxelTree`). Not
/// to be confused with an occupancy map that is an object of a scene (`VoxelMap`).
/// `SceneMirror` joins the mirrors of a scene, and writes them as OctoMap does. Conservative:
/// every voxel that a triangle touches is occupied; others are unknown to the tree, which counts as
/// free. Queries take voxels as closed boxes with faces moved outwards by
/// `VoxelGrid::face_error_m`, so rounding can add a touch but never lose one. They return false or
/// nothing for NaN, and for infinity where it has no meaning. Immutable. Thread-safe.
class ObjectMirror {
 public:
  /// Largest distance from the origin, in voxels, that OctoMap's 16-bit keys can hold.
  static constexpr std::int32_t kMaxKeyVoxels = 32768;

  static constexpr std::uint64_t kUsualMostVoxels = 10'000'000;

  /// Distances are rounded down by up to this factor.
  static constexpr double kDistanceRelativeError = kBoxCostRelativeError;

  struct BuildResult {
    std::shared_ptr<const ObjectMirror> map;  ///< null on error
    std::string error;                        ///< empty exactly when `map` is set
    Limit limit = Limit::kNone;               ///< limit that the error is about
  };

  /// Builds the mirror of `meshes` by an exact triangle-box test for every voxel, not from samples.
  /// If the meshes are the faces of `solid`, its inside is occupied, too. Fails, with an error that
  /// names the numbers, if the resolution is outside `VoxelGrid`'s limits, a vertex is not finite
  /// or beyond OctoMap's keys, or there would be more than `max_voxels` (found during the build, so
  /// memory stays below about 50 bytes per voxel allowed). Fails soon after `stop` is requested.
  static BuildResult build(std::span<const Mesh* const> meshes, double resolution_m,
                           const std::optional<PlacedVoxelMap>& solid = std::nullopt,
                           std::uint64_t max_voxels = kUsualMostVoxels,
                           const std::stop_token& stop = {});
  static BuildResult build(const Mesh& mesh, double resolution_m,
                           const std::optional<PlacedVoxelMap>& solid = std::nullopt,
                           std::uint64_t max_voxels = kUsualMostVoxels,
                           const std::stop_token& stop = {}) {
    return build(std::array{&mesh}, resolution_m, solid, max_voxels, stop);
  }

  /// The mirror of a map whose placement is the identity, at the map's own resolution: exactly its
  /// solid voxels. `bounds` are the bounds of its faces. If `mirror_before` is not null it must be
  /// the mirror of `map_before` by this function; then both mirrors share what is equal, and the
  /// cost depends on the difference. Fails like `build`.
  static BuildResult of_map(const VoxelMap& map, const geometry::Box& bounds,
                            std::uint64_t max_voxels, const ObjectMirror* mirror_before,
                            const VoxelMap* map_before, const std::stop_token& stop);

  [[nodiscard]] double resolution_m() const { return grid_.resolution_m(); }
  [[nodiscard]] const OccupancyStatistics& statistics() const { return statistics_; }

  /// Whether the voxel that OctoMap maps `point_W` to is occupied. False outside of the map.
  [[nodiscard]] bool occupied_at(const geometry::Vec3& point_W) const;

  /// Whether any occupied voxel touches `box_W`. False for an empty box. Sides may be infinite.
  [[nodiscard]] bool occupied_in_box(const geometry::Box& box_W) const;

  /// Whether any occupied voxel touches the ball. False if the radius is negative; it may be
  /// infinite.
  [[nodiscard]] bool occupied_in_sphere(const geometry::Vec3& center_W, double radius_m) const;

  /// Distance along the ray to where it enters the first occupied voxel (0 if it starts in one).
  /// Returns nothing if that is beyond `max_range_m`. The ray may start outside of the map; a ray
  /// in a face or along an edge of a voxel hits the voxel. `direction_W` need not be of unit
  /// length; for zero it returns nothing.
  [[nodiscard]] std::optional<double> ray_hit_m(const geometry::Vec3& origin_W,
                                                const geometry::Vec3& direction_W,
                                                double max_range_m) const;

  /// Distance from `point_W` to the nearest occupied voxel (0 inside one), never more than the
  /// distance to the scene itself. Returns nothing if it exceeds `max_distance_m`.
  [[nodiscard]] std::optional<double> distance_m(const geometry::Vec3& point_W,
                                                 double max_distance_m) const;

  /// Distance that a ball's centre travels straight from `from_W` to `to_W` until the ball first
  /// touches an occupied voxel (0 if it does at once). Returns nothing if it never does. Rounded
  /// down; a ball that misses a voxel by less than the rounding error touches it. The two points
  /// may be equal.
  [[nodiscard]] std::optional<double> sphere_path_hit_m(const geometry::Vec3& from_W,
                                                        const geometry::Vec3& to_W,
                                                        double radius_m) const;

  [[nodiscard]] const VoxelTree& tree() const { return tree_; }

 private:
  ObjectMirror(VoxelTree tree, const VoxelGrid& grid);
  static BuildResult made_of(VoxelTree tree, const VoxelGrid& grid, const std::stop_token& stop);

  template <typename Cost>
  [[nodiscard]] std::optional<double> cheapest(const Cost& cost, double limit, double enough) const;

  VoxelTree tree_;
  VoxelGrid grid_;
  geometry::Box bounds_;  ///< bounds of the occupied voxels
  OccupancyStatistics statistics_;
};

}  // namespace camway::scene
