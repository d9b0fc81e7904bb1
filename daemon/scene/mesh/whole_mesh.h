// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "daemon/scene/mesh/closed_surfaces.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::scene {

/// All triangles of a scene as one mesh, numbered as in the scene's index. It is joined at the
/// first use, because few callers need it and each change of the scene would copy all triangles.
/// The whole mesh of a single mesh is that mesh. Copies share the mesh.
/// Thread-safe.
class WholeMesh {
 public:
  /// An object of the scene; an occupancy map has several meshes.
  struct Part {
    std::string name;
    std::vector<std::shared_ptr<const Mesh>> meshes;  ///< none is null
  };

  /// A mesh without triangles.
  WholeMesh();
  /// Requires a mesh that is not null.
  WholeMesh(std::shared_ptr<const Mesh> mesh);
  explicit WholeMesh(std::vector<Part> parts);

  const Mesh& operator*() const { return *share(); }
  const Mesh* operator->() const { return share().get(); }
  [[nodiscard]] const std::shared_ptr<const Mesh>& share() const;

  /// The closed surfaces of the mesh. They are found at the first use and kept, because only few
  /// requests need them, and those would find the same ones again.
  [[nodiscard]] const ClosedSurfaces& closed_surfaces() const;

  /// The name of the object that contains `triangle`, without joining the meshes; empty if there is
  /// none. With several parts it is the name of the part, followed by the name of the mesh's object
  /// if the mesh has several: "table", "house/sofa".
  [[nodiscard]] std::string object_name(std::uint32_t triangle) const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace camway::scene
