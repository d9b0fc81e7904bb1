// SPDX-License-Identifier: MIT
#include "daemon/scene/mesh.h"

namespace camway::scene {

geometry::Box Mesh::bounds() const {
  geometry::Box box;
  for (const std::array<std::uint32_t, 3>& t : triangles) {
    for (const std::uint32_t v : t) box.extend(vertices[v]);
  }
  return box;
}

}  // namespace camway::scene
