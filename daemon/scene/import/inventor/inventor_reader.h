// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "daemon/base/result.h"
#include "daemon/scene/import/inventor/scene_graph.h"
#include "daemon/scene/import/record/record_layout.h"

namespace camway::scene::inventor {

/// Reads an Open Inventor or VRML 1/97 scene, as it is or compressed with gzip. Coin parses the
/// file and applies its transforms; faces, strips, spheres, cones, cylinders and NURBS are made
/// triangles here. Of a Switch the child that it chooses is read, of a level of detail the finest.
///
/// Coin trusts its file, and may crash or use any amount of memory: for an import process only.
/// Returns a record as in `record_layout.h` without the header's counts, or the reason why the file
/// is refused: what Coin could not read, or what the scene has in place of surfaces. Requires
/// `start_coin`.
base::Result<import_record::Record> read_inventor(std::string_view bytes,
                                                  const SceneFolder& folder);

}  // namespace camway::scene::inventor
