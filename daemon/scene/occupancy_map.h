// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/mesh.h"

namespace octomap {
class OcTree;
}

namespace camway::scene {

struct OccupancyStatistics {
  double resolution_m = 0.0;
  std::uint64_t occupied_voxels = 0;  ///< at full resolution, pruned nodes counted as what they cover
  std::uint64_t nodes = 0;
  std::uint64_t memory_bytes = 0;
};

/// The OctoMap mirror of a scene. Conservative: every voxel that a triangle touches is occupied.
/// Immutable; queries are const and safe from any thread.
class OccupancyMap {
 public:
  /// Largest distance of a coordinate from the origin that OctoMap's 16-bit keys can hold, in voxels.
  static constexpr std::int32_t kMaxKeyVoxels = 32768;

  struct BuildResult {
    std::shared_ptr<const OccupancyMap> map;  ///< null on error
    std::string error;
  };

  /// Exact triangle-box overlap for every voxel, not point samples. Refuses, with an error that
  /// names extent and resolution, a mesh that OctoMap's keys cannot hold, and one whose mirror
  /// would pass `max_voxels`.
  static BuildResult build(const Mesh& mesh, double resolution_m,
                           std::uint64_t max_voxels = 200'000'000);

  ~OccupancyMap();
  OccupancyMap(const OccupancyMap&) = delete;
  OccupancyMap& operator=(const OccupancyMap&) = delete;

  [[nodiscard]] double resolution_m() const;
  [[nodiscard]] OccupancyStatistics statistics() const;

  /// Whether the voxel that holds `point_W` is occupied. Outside the map: false.
  [[nodiscard]] bool occupied_at(const geometry::Vec3& point_W) const;

  /// Whether any occupied voxel touches `box_W`.
  [[nodiscard]] bool occupied_in_box(const geometry::Box& box_W) const;

  /// Whether any occupied voxel touches the ball.
  [[nodiscard]] bool occupied_in_sphere(const geometry::Vec3& center_W, double radius_m) const;

  /// Distance along the ray to the first occupied voxel (0 if it starts in one), or nothing within
  /// `max_range_m`. `direction_W` need not be of unit length; zero gives nothing.
  [[nodiscard]] std::optional<double> ray_hit_m(const geometry::Vec3& origin_W,
                                                const geometry::Vec3& direction_W,
                                                double max_range_m) const;

  /// Distance from `point_W` to the nearest occupied voxel (0 inside one), or nothing within
  /// `max_distance_m`. Never more than the distance to the scene itself.
  [[nodiscard]] std::optional<double> distance_m(const geometry::Vec3& point_W,
                                                 double max_distance_m) const;

  /// Writes OctoMap's binary format, which octovis opens. Returns an error text, empty on success.
  [[nodiscard]] std::string write_bt(const std::filesystem::path& file) const;

 private:
  explicit OccupancyMap(std::unique_ptr<const octomap::OcTree> tree);

  std::unique_ptr<const octomap::OcTree> tree_;
};

}  // namespace camway::scene
