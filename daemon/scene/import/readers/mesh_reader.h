// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "daemon/scene/import/record/import_format.h"

namespace camway::scene::mesh_readers {

struct ReadResult {
  import_format::Record
      record;           ///< as `import_format.h` describes; the header's counts are not set
  std::string refusal;  ///< why the file cannot be read; empty if it was
};

/// Whether files whose names end so (".obj", ".off", ".ply", ".stl", in any case) are for
/// `read_mesh`.
bool is_known_extension(std::string_view extension);

/// Reads a file of one of these formats, coordinates in doubles. Takes any bytes. Memory: two to
/// four times those of the file, a hundred times in one made for it (a single face whose indices
/// take a byte each). Time: linear, but for polygons of very many corners, where it may grow with
/// their cube. Precondition: `is_known_extension(extension)`.
ReadResult read_mesh(std::string_view extension, std::string_view bytes);

}  // namespace camway::scene::mesh_readers
