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

/// All that is computed from a mesh file before anything is planned in it, but for the occupancy
/// mirror. The object stands where its file has it. Parts are shared with the scenes made of it.
struct PreparedScene {
  std::shared_ptr<const IndexedMesh> indexed;  ///< never null; has a triangle at least
  ImportReport report;                         ///< report on the import of the mesh
  std::shared_ptr<const DistanceField> field;  ///< null if there is none
  std::string why_no_field;                    ///< empty exactly when `field` is set
  std::string digest;                          ///< `mesh_digest` of the mesh
};

}  // namespace camway::scene
