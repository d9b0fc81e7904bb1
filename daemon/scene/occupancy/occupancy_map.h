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
#include "daemon/scene/occupancy/box_costs.h"
#include "daemon/scene/occupancy/voxel_tree.h"
#include "daemon/scene/voxels/voxel_grid.h"
#include "daemon/scene/voxels/voxel_map.h"

namespace camway::scene {

struct OccupancyStatistics {
  double resolution_m = 0.0;
  std::uint64_t occupied_voxels = 0;  ///< at full resolution, large cubes as what they cover
  std::uint64_t nodes = 0;
  std::uint64_t memory_bytes = 0;
};

/// The OctoMap mirror of a scene (Hornung et al. 2013, "OctoMap"): its voxels and the cubes that
/// its tree makes of them, in a form that is faster to search (`VoxelTree`); `OccupancyMirror`
/// writes them as OctoMap does. Conservative: every voxel that a triangle touches is occupied, and
/// what is not occupied is unknown to the tree, which counts as free here. The voxels of a query
/// are closed boxes, faces moved outwards by `VoxelGrid::face_error_m`, so that rounding can add a
/// touch and never lose one. A query with NaN, or an infinity where it has no meaning, answers
/// false or nothing. Immutable; queries are const and safe from any thread.
class OccupancyMap {
 public:
  /// Largest distance of a coordinate from the origin that OctoMap's 16-bit keys can hold, in
  /// voxels.
  static constexpr std::int32_t kMaxKeyVoxels = 32768;

  static constexpr std::uint64_t kUsualMostVoxels = 10'000'000;

  /// Distances are rounded down by up to this factor.
  static constexpr double kDistanceRelativeError = kBoxCostRelativeError;

  struct BuildResult {
    std::shared_ptr<const OccupancyMap> map;  ///< null on error
    std::string error;                        ///< empty exactly when `map` is set
    Limit limit = Limit::kNone;               ///< that the error is about
  };

  /// Exact triangle-box overlap for every voxel, not point samples. Refuses, with an error that
  /// names extent and resolution, a resolution outside `VoxelGrid`'s limits, a mesh that OctoMap's
  /// keys cannot hold, and one whose mirror would pass `max_voxels` (found while building, so that
  /// memory stays below about 50 bytes for each voxel allowed).
  /// Of a solid, of which the meshes are the faces, what is inside is occupied, too. Fails soon
  /// after `stop` is asked for.
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

  /// Of a map that stands where its file has it, at its own resolution: its voxels, and no others.
  /// Where `mirror_before`, which may be null, is this of `map_before`, the two share what does not
  /// differ, and it costs what does. `bounds` are those of its faces. Refuses, and stops, as
  /// `build` does.
  static BuildResult of_map(const VoxelMap& map, const geometry::Box& bounds,
                            std::uint64_t max_voxels, const OccupancyMap* mirror_before,
                            const VoxelMap* map_before, const std::stop_token& stop);

  [[nodiscard]] double resolution_m() const { return grid_.resolution_m(); }
  [[nodiscard]] const OccupancyStatistics& statistics() const { return statistics_; }

  /// Whether the voxel that OctoMap maps `point_W` to is occupied. Outside the map: false.
  [[nodiscard]] bool occupied_at(const geometry::Vec3& point_W) const;

  /// Whether any occupied voxel touches `box_W`. An empty box touches nothing; sides may be
  /// infinite.
  [[nodiscard]] bool occupied_in_box(const geometry::Box& box_W) const;

  /// Whether any occupied voxel touches the ball. A negative radius: false; it may be infinite.
  [[nodiscard]] bool occupied_in_sphere(const geometry::Vec3& center_W, double radius_m) const;

  /// Distance along the ray to where it enters the first occupied voxel (0 if it starts in one), or
  /// nothing within `max_range_m`. The ray may start outside the map, and one that runs in a face
  /// or along an edge of a voxel hits it. `direction_W` need not be of unit length; zero gives
  /// nothing.
  [[nodiscard]] std::optional<double> ray_hit_m(const geometry::Vec3& origin_W,
                                                const geometry::Vec3& direction_W,
                                                double max_range_m) const;

  /// Distance from `point_W` to the nearest occupied voxel (0 inside one), or nothing within
  /// `max_distance_m`. Never more than the distance to the scene itself.
  [[nodiscard]] std::optional<double> distance_m(const geometry::Vec3& point_W,
                                                 double max_distance_m) const;

  /// How far a ball gets on the straight way between two points: the way of its centre to where it
  /// first touches an occupied voxel (0 if it does at once), or nothing: it never does. Rounded
  /// down, and a ball that passes a voxel at less than the rounding of the numbers touches it. A
  /// way may have no length.
  [[nodiscard]] std::optional<double> sphere_path_hit_m(const geometry::Vec3& from_W,
                                                        const geometry::Vec3& to_W,
                                                        double radius_m) const;

  [[nodiscard]] const VoxelTree& tree() const { return tree_; }

 private:
  OccupancyMap(VoxelTree tree, const VoxelGrid& grid);
  static BuildResult made_of(VoxelTree tree, const VoxelGrid& grid, const std::stop_token& stop);

  template <typename Cost>
  [[nodiscard]] std::optional<double> cheapest(const Cost& cost, double limit, double enough) const;

  VoxelTree tree_;
  VoxelGrid grid_;
  geometry::Box bounds_;  ///< of the occupied voxels
  OccupancyStatistics statistics_;
};

}  // namespace camway::scene
