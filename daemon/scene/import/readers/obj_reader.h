// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "daemon/scene/import/readers/mesh_collector.h"

namespace camway::scene::mesh_readers {

/// Reads Wavefront OBJ: vertices (three coordinates, then perhaps a weight w, by which they are
/// divided, or a colour), faces, groups and materials; `\` at the end of a line, indices from the
/// end, comments. Counts lines, points, free-form curves and surfaces (`surf`, `curv`, and `bzp`
/// and the like of old versions), and unknown statements, since a misspelt one may have been a
/// face. Any text is an OBJ file, perhaps one without faces. Materials are not loaded, but divide
/// objects, whose names are those that assimp gives: the last `o` or `g`, followed by `/material`
/// where the material changes within.
void read_obj(std::string_view bytes, MeshCollector& mesh);

}  // namespace camway::scene::mesh_readers
