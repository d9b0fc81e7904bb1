// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "daemon/scene/import/readers/mesh_collector.h"

namespace camway::scene::mesh_readers {

/// Reads Geomview's OFF in text, with or without its keyword, and its variants (COFF, NOFF, STOFF,
/// 4OFF with a weight by which coordinates are divided, nOFF of three dimensions). Expects one
/// vertex or face per line, as all programs write it, and ignores the rest of the line: colours and
/// the like. The number of edges may be missing. Returns why the file is refused, or an empty text.
std::string read_off(std::string_view bytes, MeshCollector& mesh);

}  // namespace camway::scene::mesh_readers
