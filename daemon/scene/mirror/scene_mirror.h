// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/scene/mirror/object_mirror.h"

namespace camway::scene {

/// The OctoMap mirror of a scene of several objects: an `ObjectMirror` for each, all of one
/// resolution. So a change of an object leaves the other mirrors as they are, and removing it frees
/// the voxels that no other object touches. A voxel is occupied if any mirror occupies it. Queries
/// are those of `ObjectMirror` over all mirrors. Immutable. Thread-safe.
class SceneMirror {
 public:
  /// Makes the mirror of a scene with one object.
  explicit SceneMirror(std::shared_ptr<const ObjectMirror> mirror);
  /// Requires that no mirror is null and that all have this resolution.
  SceneMirror(double resolution_m, std::vector<std::shared_ptr<const ObjectMirror>> mirrors);

  [[nodiscard]] double resolution_m() const { return statistics_.resolution_m; }
  /// Sums over the mirrors: a voxel that two objects touch counts twice.
  [[nodiscard]] const OccupancyStatistics& statistics() const { return statistics_; }

  [[nodiscard]] bool occupied_at(const geometry::Vec3& point_W) const;
  [[nodiscard]] bool occupied_in_box(const geometry::Box& box_W) const;
  [[nodiscard]] bool occupied_in_sphere(const geometry::Vec3& center_W, double radius_m) const;
  [[nodiscard]] std::optional<double> ray_hit_m(const geometry::Vec3& origin_W,
                                                const geometry::Vec3& direction_W,
                                                double max_range_m) const;
  [[nodiscard]] std::optional<double> distance_m(const geometry::Vec3& point_W,
                                                 double max_distance_m) const;
  [[nodiscard]] std::optional<double> sphere_path_hit_m(const geometry::Vec3& from_W,
                                                        const geometry::Vec3& to_W,
                                                        double radius_m) const;

  /// Writes all voxels as one map in OctoMap's binary format, which octovis opens. The cost depends
  /// on the number of voxels. Returns an error text, empty on success.
  [[nodiscard]] std::string write_bt(const std::filesystem::path& file) const;
  void write_bt(std::ostream& out) const;

 private:
  std::vector<std::shared_ptr<const ObjectMirror>> mirrors_;
  OccupancyStatistics statistics_;
};

}  // namespace camway::scene
