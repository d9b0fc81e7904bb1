// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "daemon/scene/import/readers/mesh_collector.h"

namespace camway::scene::mesh_readers {

/// Reads Wavefront OBJ. Never fails: any text is an OBJ file, perhaps one without faces.
///
/// - A vertex has three coordinates, then perhaps a weight w, by which they are divided, or a
/// colour.
/// - Faces may count vertices from the end. `\` continues a line. Comments are skipped.
/// - Lines, points, free-form curves and surfaces (`surf`, `curv`, and `bzp` and the like of old
///   versions) are counted. So are unknown statements, because a misspelt one may have been a face.
/// - Materials are not loaded, but a change of material begins an object. An object has the name
/// that
///   assimp gives it: the last `o` or `g`, followed by `/material` if the material changes within.
void read_obj(std::string_view bytes, MeshCollector& mesh);

}  // namespace camway::scene::mesh_readers
