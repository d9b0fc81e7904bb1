// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "daemon/base/result.h"
#include "daemon/scene/import/record/record_layout.h"

namespace camway::scene::mesh_readers {

/// Whether `read_mesh` reads files with this extension (".obj", ".off", ".ply", ".stl", in any
/// case).
bool is_known_extension(std::string_view extension);

/// Reads a file of one of these formats, with coordinates in doubles. Accepts any bytes. Memory:
/// two to four times the size of the file, a hundred times for one made for that (a single face
/// whose indices take a byte each). Time: linear, except for polygons of very many corners, where
/// it may grow with their cube. Returns a record as in `record_layout.h` without the header's
/// counts, or the reason why the file cannot be read. Requires `is_known_extension(extension)`.
base::Result<import_record::Record> read_mesh(std::string_view extension, std::string_view bytes);

}  // namespace camway::scene::mesh_readers
