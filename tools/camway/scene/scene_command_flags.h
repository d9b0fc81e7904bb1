// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace camway::tools {

/// Options of the subcommands of `camway scene`.
struct SceneCommandFlags {
  std::string url;
  std::string prefix = "CAMWAY";
  std::string key_file;
  std::optional<double> timeout_s;
  double deadline_s = ClientOptions{}.change_deadline_s;
  std::string scene;
  std::string object;
  std::string file;         ///< below a root of the daemon
  std::string upload_file;  ///< here
  std::string to_file;      ///< here, written
  std::int64_t revision = 0;
  std::string restore_as;
  double scale = 1.0;
  SceneMesh::Up up = SceneMesh::Up::kAsInFile;
  SceneMesh::Unknown unknown = SceneMesh::Unknown::kFree;
  double voxel_m = 0.0;
  double occupancy_m = 0.0;
  std::string bounds;
  std::vector<double> box_m;
  std::vector<double> cylinder_m;
  std::optional<double> sphere_m;
  double chord_error_m = 0.0;
  std::optional<double> map_m;
  SceneSensor sensor;
  std::string points_file;
  std::vector<double> origin_m;
  std::vector<double> position_m;  ///< empty: not given, as the next
  std::vector<double> orientation_wxyz;
};

}  // namespace camway::tools
