// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace camway::wire {

/// The triangles of an object as `TRIANGLES` sends them: the bytes of all pages together
/// (docs/wire.md). Coordinates are in the frame of the object, in metres.
struct ObjectMesh {
  struct Part {
    std::string name;             ///< of a part of the file; may be empty
    std::uint32_t triangles = 0;  ///< number of its triangles
  };
  bool has_inside = false;       ///< whether the object is an occupancy map, which has an inside
  double surface_error_m = 0.0;  ///< distance of smooth surfaces from their triangles
  std::vector<std::array<double, 3>> vertices_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of vertices
  std::vector<Part> parts;  ///< in order of their triangles; together they cover all
};

/// Returns the bytes of a mesh.
std::vector<std::uint8_t> encode_mesh(const ObjectMesh& mesh);

/// Returns the mesh; nothing if the bytes are of no mesh whose numbers are finite, whose indices
/// are valid and whose parts cover its triangles.
std::optional<ObjectMesh> decode_mesh(std::span<const std::uint8_t> bytes);

}  // namespace camway::wire
