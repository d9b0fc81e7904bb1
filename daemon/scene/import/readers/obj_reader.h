// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "daemon/scene/import/readers/mesh_collector.h"

namespace camway::scene::mesh_readers {

/// Wavefront OBJ: vertices (three coordinates, then perhaps a weight w, by which they are divided,
/// or a colour), faces, groups and materials; `\` at the end of a line, indices from the end,
/// comments. Lines, points and free-form curves and surfaces (`surf`, `curv`, and
/// `bzp` and its like of old versions) are counted, and so are statements that nobody knows: a slip
/// may have been a face. Any text is an OBJ file, if
/// an empty one. Materials are not looked up; they part objects, which are named as assimp names
/// them: by the last `o` or `g`, with `/material` behind it where the material changes within.
void read_obj(std::string_view bytes, MeshCollector& mesh);

}  // namespace camway::scene::mesh_readers
