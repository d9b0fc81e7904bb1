// SPDX-License-Identifier: MIT
#include "daemon/scene/import/child/assimp_refusal.h"

#include <array>

#include "daemon/scene/import/readers/tokens.h"

namespace camway::scene {
namespace {

using mesh_readers::equals_ignoring_case;

bool has(std::string_view text, std::string_view wanted) {
  return text.find(wanted) != std::string_view::npos;
}

bool is_gltf(std::string_view extension) {
  return equals_ignoring_case(extension, ".glb") || equals_ignoring_case(extension, ".gltf");
}

/// Extensions with which geometry is not in the buffers as it is. Draco is read.
constexpr std::array<std::string_view, 2> kUnknownCompressions = {"EXT_meshopt_compression",
                                                                  "KHR_meshopt_compression"};

}  // namespace

std::string refusal_of_assimp(std::string_view extension, std::string_view begin,
                              const std::string& error) {
  if (is_gltf(extension)) {
    for (const std::string_view compression : kUnknownCompressions) {
      if (has(begin, compression)) {
        return "its meshes are compressed (" + std::string(compression) +
               "), which is not read: write the file without compression, or with Draco";
      }
    }
  }
  const bool is_ifc = equals_ignoring_case(extension, ".ifc");
  if (is_ifc && (has(begin, "'IFC4") || has(begin, "\"IFC4"))) {
    return "is of the schema IFC4, of which assimp reads a part only (" + error +
           "): export it as IFC2x3, or as glTF";
  }
  // The name of what its reader threw, which says nothing to people.
  if (error.starts_with("std::")) {
    return "it is damaged, or has what assimp does not know (" + error + ")";
  }
  return error;
}

}  // namespace camway::scene
