// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/scene/snapshot/scene_object.h"

namespace camway::service {

/// Returns the triangles of an object as `TRIANGLES` sends them (`wire::ObjectMesh`): in the order
/// of the scene's numbers, in the frame of the object. Those of an occupancy map are its faces.
std::vector<std::uint8_t> sent_mesh(const scene::SceneObject& object);

}  // namespace camway::service
