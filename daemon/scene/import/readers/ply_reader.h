// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "daemon/scene/import/readers/mesh_collector.h"

namespace camway::scene::mesh_readers {

/// What a PLY file is called, by its encoding, and by how much its coordinates may be off: nothing
/// in binary files.
struct PlyKind {
  std::string_view format;
  double relative_rounding = 0.0;
};

/// Polygon files of Stanford, text and binary of either byte order, with properties of any type in
/// any order. Read are the `x`, `y`, `z` of `vertex`, the `vertex_indices` (or `vertex_index`) of
/// `face` and of `tristrips`; the elements `edge`, and the vertices of a file without faces, are
/// counted as lines and points; all else is passed over. Returns why the file is refused, or an
/// empty text.
std::string read_ply(std::string_view bytes, MeshCollector& mesh, PlyKind& kind);

}  // namespace camway::scene::mesh_readers
