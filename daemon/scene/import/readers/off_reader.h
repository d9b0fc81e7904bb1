// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "daemon/scene/import/readers/mesh_collector.h"

namespace camway::scene::mesh_readers {

/// Reads OFF in text, as the Geomview manual defines it ("Object File Formats", OFF Files), with or
/// without its keyword. The variants COFF, NOFF and STOFF are read; 4OFF with a weight by which
/// coordinates are divided; and nOFF of three dimensions.
///
/// Deviations: expects one vertex or face per line, as all programs write it, and ignores the rest
/// of the line (colours, normals, texture coordinates). The number of edges may be missing.
///
/// Returns why the file is refused, or an empty text. After a refusal, `mesh` holds the vertices
/// and faces that were read before the fault.
std::string read_off(std::string_view bytes, MeshCollector& mesh);

}  // namespace camway::scene::mesh_readers
