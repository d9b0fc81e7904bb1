// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "daemon/scene/import/readers/included_file.h"
#include "daemon/scene/import/record/record_layout.h"

namespace camway::scene {

/// Whether this is the name of a file of voxels of Gaussian splats: it ends in ".voxel.json", in
/// any case.
bool is_splat_voxel_name(std::string_view name);

/// Reads voxels as SuperSplat and splat-transform write them: version 1 of a sparse octree with
/// leaves of 4 x 4 x 4 voxels. `json` describes the grid. The tree is in a second file, which has
/// the same name with ".bin" in place of ".json", and is opened by `open`. Voxels that are solid
/// are occupied; the others of the grid are free. Accepts any bytes: each node is read once, and a
/// tree that says otherwise is refused. Memory and time: in proportion to the tree.
base::Result<import_record::Record> read_splat_voxels(const std::string& name,
                                                      std::string_view json,
                                                      const OpenInclude& open);

}  // namespace camway::scene
