// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "daemon/geometry/types.h"
#include "daemon/scene/import/record/import_options.h"

namespace camway::scene {

/// What was read and what was assumed, so that a wrong unit or axis is seen at once.
struct ImportReport {
  std::string format;  ///< in the words of our reader or of assimp's
  double scale = 1.0;
  UpAxis up = UpAxis::kAsInFile;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint64_t objects = 0;
  geometry::Box bounds_m;
  std::uint64_t degenerate_triangles = 0;  ///< of zero area; kept out of the scene
  std::uint64_t dropped_nonfinite = 0;     ///< triangles with a NaN or infinite coordinate
  /// Faces that name a vertex that does not exist. (Not those that assimp mends itself: in a glTF
  /// file it leaves the face out.)
  std::uint64_t dropped_bad_index = 0;
  std::uint64_t dropped_points_and_lines = 0;  ///< primitives that are no surface
  std::uint64_t dropped_freeform = 0;          ///< curved surfaces, which no reader knows
  /// Lines of an OBJ file with a keyword that means nothing: a slip may have been a face.
  std::uint64_t ignored_statements = 0;
  /// Whether coordinates went through single precision, as assimp keeps them. OBJ, OFF, PLY and STL
  /// files are read in doubles.
  bool single_precision = false;
  /// No coordinate of the scene is further than this from the number in the file times the scale
  /// (and the transforms that the file says). 0 where the file holds doubles or floats and the
  /// scale is 1; for decimals in doubles half a unit in the last place. What a reader of
  /// assimp's computes beyond that (curves of IFC made flat) is not in it.
  double rounding_m = 0.0;
};

}  // namespace camway::scene
