// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "daemon/scene/mesh/mesh.h"

namespace camway::scene {

/// All triangles of a scene as one mesh. It is put together when somebody asks for it first, since
/// few do and a scene that changes often would have to copy all of its triangles each time; of one
/// mesh it is that mesh. Triangles are numbered as in the scene's index. A handle: copies share the
/// mesh. Safe from any thread.
class WholeMesh {
 public:
  /// An object of the scene; of several meshes if it is an occupancy map.
  struct Part {
    std::string name;
    std::vector<std::shared_ptr<const Mesh>> meshes;  ///< none is null
  };

  /// Of no triangles.
  WholeMesh();
  /// Precondition: not null.
  WholeMesh(std::shared_ptr<const Mesh> mesh);  // NOLINT: implicit, it is the same thing
  explicit WholeMesh(std::vector<Part> parts);

  const Mesh& operator*() const { return *share(); }
  const Mesh* operator->() const { return share().get(); }
  [[nodiscard]] const std::shared_ptr<const Mesh>& share() const;

  /// The name of the object that holds `triangle`, without putting the mesh together. Of several
  /// parts it begins with the name of the part, and ends there if that has but one object: "table",
  /// "house/sofa". Empty if there is none.
  [[nodiscard]] std::string object_name(std::uint32_t triangle) const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace camway::scene
