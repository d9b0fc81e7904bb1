// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/path.h"
#include "daemon/planning/request.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::bench {

/// A request as the benchmarks need it, and the motion through its keyframes.
struct BenchRequest {
  std::string name;        ///< of the file, without folder and ending
  std::string difficulty;  ///< the word in the name that says it: free, graze, wall, ...
  motion::Camera camera;
  motion::Path path;
  std::size_t keyframes = 0;
  planning::PlanRequest plan = {};  ///< as read, but with times and quaternions of length 1
};

/// A scene and the requests in it.
struct BenchScene {
  std::string name;
  std::shared_ptr<const scene::Mesh> mesh;
  std::vector<BenchRequest> requests;
};

/// Where requests come from.
struct RequestSource {
  std::string requests;   ///< a folder or a file
  std::string scene;      ///< a file; empty: the one that each request names
  double scale = 1.0;     ///< of the scene's coordinates
  std::string only = {};  ///< requests with this in their name; empty: all
  /// So many of each difficulty and scene, the first ones.
  std::size_t each = std::numeric_limits<std::size_t>::max();
};

/// Reads all requests of a folder, in order of name, and the scenes they are in. Index files
/// (`*.index.json`) are passed over. Ends the program with a message if something cannot be read:
/// a benchmark of half of a set is of no use.
std::vector<BenchScene> load_requests(const RequestSource& source);

/// The scene alone; ends the program if it cannot be read.
std::shared_ptr<const scene::Mesh> load_mesh(const std::string& file, double scale);

/// The folder of the project's own scenes.
std::string own_scenes();

}  // namespace camway::bench
