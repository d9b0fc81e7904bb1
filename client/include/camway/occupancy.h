// SPDX-License-Identifier: MIT
#pragma once

#include <camway/status.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace camway {

/// An axis-aligned box. [Limit: min_m[i] <= max_m[i]]
struct OccupancyBox {
  std::array<double, 3> min_m{};
  std::array<double, 3> max_m{};
};

struct OccupancySphere {
  std::array<double, 3> center_m{};
  double radius_m = 0.0;
};

struct OccupancyRay {
  std::array<double, 3> origin_m{};
  std::array<double, 3> direction{};  ///< any length except 0
  double range_m = 0.0;               ///< length of the ray
};

struct OccupancyDistance {
  std::array<double, 3> point_m{};
  double max_m = 0.0;  ///< largest distance to search
};

/// A ball that moves along a straight line.
struct OccupancySpherePath {
  std::array<double, 3> from_m{};
  std::array<double, 3> to_m{};  ///< may equal `from_m`
  double radius_m = 0.0;
};

/// Queries of the occupancy map of one scene, in any number. A batch that is too large for one
/// message is sent as several.
struct OccupancyBatch {
  std::string scene;
  double deadline_s = 0.0;  ///< for each message, from its receipt; 0: the daemon's default
  std::vector<std::array<double, 3>> points_m;    ///< is the voxel that holds the point occupied?
  std::vector<OccupancyBox> boxes;                ///< does an occupied voxel touch the box?
  std::vector<OccupancySphere> spheres;           ///< does an occupied voxel touch the ball?
  std::vector<OccupancyRay> rays;                 ///< how far is the first occupied voxel?
  std::vector<OccupancyDistance> distances;       ///< how far is the nearest occupied voxel?
  std::vector<OccupancySpherePath> sphere_paths;  ///< how far can the ball move?
};

/// The answers to a batch. When `ok()`, each list has the length and the order of its queries;
/// otherwise all lists are empty. The map is conservative: every voxel that a triangle touches is
/// occupied, and distances are never too long.
struct OccupancyAnswer {
  Status status = Status::kNoAnswer;
  std::string error;  ///< the failure and its remedy; empty when `ok()`

  bool ok() const { return status == Status::kOk; }

  DaemonStart daemon_start;  ///< of the daemon that answered
  std::vector<bool> points_occupied;
  std::vector<bool> boxes_occupied;
  std::vector<bool> spheres_occupied;
  /// Distances along the rays to the first occupied voxel; unset if none is within range.
  std::vector<std::optional<double>> rays_hit_m;
  /// Distances to the nearest occupied voxel; unset if none is within `OccupancyDistance::max_m`.
  std::vector<std::optional<double>> distances_m;
  /// Distances that the centres move until the ball touches an occupied voxel; unset if it never
  /// does.
  std::vector<std::optional<double>> sphere_paths_hit_m;

  double resolution_m = 0.0;        ///< edge of a voxel
  std::int64_t scene_revision = 0;  ///< revision that all answers of the batch hold for
};

}  // namespace camway
