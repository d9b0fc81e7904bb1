// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/path.h"
#include "daemon/planning/request/request.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::bench {

/// A request of a benchmark, and the path through its keyframes.
struct BenchRequest {
  std::string name;        ///< name of the file, without folder and extension
  std::string difficulty;  ///< word in the name: free, graze, wall, ...
  motion::Camera camera;
  motion::Path path;
  std::size_t keyframes = 0;
  planning::PlanRequest plan = {};  ///< request with derived times and unit quaternions
};

/// A scene and the requests in it.
struct BenchScene {
  std::string name;
  std::shared_ptr<const scene::Mesh> mesh;
  std::vector<BenchRequest> requests;
};

/// The source of the requests.
struct RequestSource {
  std::string requests;   ///< a folder or a file
  std::string scene;      ///< a file; empty: the scene that each request names
  double scale = 1.0;     ///< factor to the scene's coordinates
  std::string only = {};  ///< text that the names of the requests must contain; empty: all
  /// Largest number of requests of each difficulty and scene.
  std::size_t each = std::numeric_limits<std::size_t>::max();
};

/// Reads all requests of a folder, in order of name, and their scenes. Skips index files
/// (`*.index.json`). Ends the program with a message if a file cannot be read, because a benchmark
/// of a part of the set has no meaning.
std::vector<BenchScene> load_requests(const RequestSource& source);

/// Requests, their scene, and the factor to its coordinates.
using RequestSet = std::tuple<std::string, std::string, double>;

/// Reads all requests of `sets` as `load_requests` does, with the other members of `source`; those
/// of `source` itself if there are no sets.
std::vector<BenchScene> load_sets(const RequestSource& source, const std::vector<RequestSet>& sets);

/// Reads a scene. Ends the program if it cannot be read.
std::shared_ptr<const scene::Mesh> load_mesh(const std::string& file, double scale);

/// Returns the folder of the project's own scenes.
std::string own_scenes();

}  // namespace camway::bench
