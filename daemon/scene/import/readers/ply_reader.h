// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "daemon/scene/import/readers/mesh_collector.h"

namespace camway::scene::mesh_readers {

/// Name of a PLY file's encoding, and the relative rounding of its coordinates: 0 for binary files.
struct PlyKind {
  std::string_view format;
  double relative_rounding = 0.0;
};

/// Reads Stanford's polygon files, text or binary of either byte order, with properties of any type
/// in any order: the `x`, `y`, `z` of `vertex`, the `vertex_indices` (or `vertex_index`) of `face`
/// and of `tristrips`. Elements `edge` count as lines; the vertices of a file without faces count
/// as points. Skips all else. Returns why the file is refused, or an empty text.
std::string read_ply(std::string_view bytes, MeshCollector& mesh, PlyKind& kind);

}  // namespace camway::scene::mesh_readers
