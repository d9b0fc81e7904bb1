// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "daemon/scene/field/distance_field.h"
#include "daemon/scene/import/record/import_options.h"
#include "daemon/scene/import/record/import_report.h"
#include "daemon/scene/index/index_tree.h"

namespace camway::scene {

/// Options of the preparation of a scene file. With the file, they determine the prepared scene.
struct PreparationOptions {
  ImportOptions import;
  IndexOptions index;
  std::optional<DistanceFieldOptions> field;  ///< nothing: no field
};

/// Everything that is computed from a mesh file before the first request, except the occupancy
/// mirror. Coordinates are those of the import: no placement is applied. Scenes made from it share
/// its parts.
struct PreparedScene {
  std::shared_ptr<const IndexedMesh> indexed;  ///< never null; has at least one triangle
  ImportReport report;                         ///< report on the import of the mesh
  std::shared_ptr<const DistanceField> field;  ///< null if there is none
  std::string why_no_field;                    ///< empty exactly when `field` is set
  std::string digest;                          ///< `mesh_digest` of the mesh
};

}  // namespace camway::scene
