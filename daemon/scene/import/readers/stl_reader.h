// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "daemon/scene/import/readers/mesh_collector.h"

namespace camway::scene::mesh_readers {

/// Returns whether the bytes are a binary STL file: their length is that of their number of facets,
/// or they do not begin like text. (Many binary files begin with "solid", too.)
bool is_binary_stl(std::string_view bytes);

/// Reads stereolithography files, binary (floats) or text, with any number of solids. Ignores
/// normals and attributes. Returns why the file is refused, or an empty text. After a refusal,
/// `mesh` holds the facets that were read before the fault.
std::string read_stl(std::string_view bytes, MeshCollector& mesh);

}  // namespace camway::scene::mesh_readers
