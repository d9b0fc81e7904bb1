// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "daemon/scene/import/readers/mesh_collector.h"

namespace camway::scene::mesh_readers {

/// Whether the bytes are a binary STL file: as long as its number of facets says, or longer while
/// they do not begin as text does. (Many binary files begin with "solid" too.)
bool is_binary_stl(std::string_view bytes);

/// Stereolithography files, binary (floats) and text, with any number of solids. Normals and
/// attributes are not read. Returns why the file is refused, or an empty text.
std::string read_stl(std::string_view bytes, MeshCollector& mesh);

}  // namespace camway::scene::mesh_readers
