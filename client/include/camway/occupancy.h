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
  std::array<double, 3> direction{};  ///< any length but zero
  double range_m = 0.0;
};

struct OccupancyDistance {
  std::array<double, 3> point_m{};
  double max_m = 0.0;  ///< largest distance of interest
};

/// A ball that moves straight from one point to another.
struct OccupancySpherePath {
  std::array<double, 3> from_m{};
  std::array<double, 3> to_m{};  ///< may be where it begins
  double radius_m = 0.0;
};

/// Questions to the occupancy map of one scene, as many as you like: what does not fit one message
/// is sent as several.
struct OccupancyBatch {
  std::string scene;
  /// How long the daemon may take for each of these messages, from its receipt; 0: its own default.
  double deadline_s = 0.0;
  std::vector<std::array<double, 3>> points_m;    ///< is the voxel that holds the point occupied?
  std::vector<OccupancyBox> boxes;                ///< does an occupied voxel touch the box?
  std::vector<OccupancySphere> spheres;           ///< does an occupied voxel touch the ball?
  std::vector<OccupancyRay> rays;                 ///< how far is the first occupied voxel?
  std::vector<OccupancyDistance> distances;       ///< how far is the nearest occupied voxel?
  std::vector<OccupancySpherePath> sphere_paths;  ///< how far does the ball get?
};

/// Answers in the order of the batch and, when `ok()`, as many; otherwise the lists are empty. The
/// map is conservative: every voxel that a triangle touches is occupied.
struct OccupancyAnswer {
  Status status = Status::kNoAnswer;
  std::string error;  ///< what failed and what to do about it; empty when `ok()`

  bool ok() const { return status == Status::kOk; }

  std::vector<bool> points_occupied;
  std::vector<bool> boxes_occupied;
  std::vector<bool> spheres_occupied;
  std::vector<std::optional<double>> rays_hit_m;   ///< along the ray; nothing within its range
  std::vector<std::optional<double>> distances_m;  ///< nothing within the distance of interest
  /// Way of the centre to where the ball first touches an occupied voxel; nothing: all of it is
  /// free
  std::vector<std::optional<double>> sphere_paths_hit_m;

  double resolution_m = 0.0;        ///< edge of a voxel
  std::int64_t scene_revision = 0;  ///< one for all answers of a batch
};

}  // namespace camway
