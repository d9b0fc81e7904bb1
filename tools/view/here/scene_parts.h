// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "daemon/scene/snapshot/snapshot.h"
#include "tools/view/backend.h"

namespace camway::view {

/// Returns the mesh of the first object of that digest, in the frame of the object. Shares that of
/// an object with one part.
MeshAnswer object_mesh(const scene::Snapshot& snapshot, std::string_view digest);

/// Returns triangles of the scene, as `Backend::triangles` does.
Answer scene_triangles(const scene::Snapshot& snapshot, const std::vector<std::int64_t>& indices);

}  // namespace camway::view
