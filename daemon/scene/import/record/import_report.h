// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/import/record/import_options.h"

namespace camway::scene {

/// The content of a file and the assumptions of its import, so that wrong units or axes show.
struct ImportReport {
  std::string format;  ///< as our reader or assimp calls it
  /// Sentences for the user about what was read, left out and assumed. Not kept in caches and logs.
  std::vector<std::string> notes;
  double unit_m = 0.0;  ///< metres per file unit as the file says; 0 if it does not
  double scale = 1.0;   ///< metres per file unit, as read
  UpAxis up = UpAxis::kAsInFile;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint64_t objects = 0;
  geometry::Box bounds_m;
  std::uint64_t degenerate_triangles = 0;  ///< triangles of zero area; left out
  std::uint64_t dropped_nonfinite = 0;     ///< triangles with a coordinate not finite, or too large
  /// Faces with a vertex that does not exist. (assimp leaves out such faces of glTF files itself,
  /// without counting them.)
  std::uint64_t dropped_bad_index = 0;
  std::uint64_t dropped_points_and_lines = 0;  ///< primitives that are no surface
  std::uint64_t dropped_freeform = 0;          ///< curved surfaces, which no reader knows
  /// Lines of an OBJ file with an unknown keyword: a misspelt one may have been a face.
  std::uint64_t ignored_statements = 0;
  /// Whether coordinates went through single precision, as in assimp. OBJ, OFF, PLY and STL files
  /// are read in doubles.
  bool single_precision = false;
  /// Bound of the difference between a coordinate of the scene and the number in the file times the
  /// scale (and the transforms in the file). 0 if the file holds doubles or floats and the scale is
  /// 1; half a unit in the last place for decimals in doubles. Further computations of a reader of
  /// assimp's (curves of IFC made flat) are not included.
  double rounding_m = 0.0;
  /// Bound of the distance between smooth surfaces of the file (spheres, cones, cylinders, NURBS)
  /// and the triangles that stand for them, both ways. 0 if the file has none, or if its reader
  /// does not say: assimp's readers of IFC and the like make curves flat without a bound. Paths
  /// keep this distance from every triangle of the scene, in addition to the clearance.
  double surface_error_m = 0.0;
};

}  // namespace camway::scene
