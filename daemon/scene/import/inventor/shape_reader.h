// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "daemon/scene/import/readers/mesh_collector.h"

class SoNode;

namespace camway::scene::inventor {

/// More do not fit into the memory of the import process, by default.
inline constexpr std::size_t kMostVerticesAndTriangles = 100'000'000;

/// Counts of nodes of a scene that gave no triangles.
struct ShapeCounts {
  std::map<std::string, std::uint64_t> no_surface;   ///< shapes that are none, by their type
  std::map<std::string, std::uint64_t> unknown;      ///< shapes of types that are not read
  std::map<std::string, std::uint64_t> no_freeform;  ///< surfaces that were left out, by the reason
  std::uint64_t shapes = 0;                          ///< that gave triangles
  std::uint64_t smooth = 0;      ///< spheres, cones, cylinders and NURBS among them
  std::uint64_t texts = 0;       ///< among them
  std::uint64_t trimmed = 0;     ///< NURBS whose trimming was not applied
  std::uint64_t not_chosen = 0;  ///< children of switches
  std::uint64_t invisible = 0;   ///< shapes of draw style INVISIBLE
  double surface_error = 0.0;    ///< in scene units
  double rounding = 0.0;         ///< of transforms, in scene units
  bool is_too_large = false;     ///< has more than `kMostVerticesAndTriangles`
};

/// Adds the shapes of a scene to a mesh, each an object named after the nearest node above it that
/// has a name, or else after its type. A shape that is used several times is several objects.
ShapeCounts add_shapes(SoNode& root, mesh_readers::MeshCollector& mesh);

}  // namespace camway::scene::inventor
