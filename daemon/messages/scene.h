// SPDX-License-Identifier: MIT
#pragma once

#include <camway/scene_change_t.hpp>
#include <camway/scene_info_t.hpp>
#include <camway/scene_object_t.hpp>

#include "daemon/scene/snapshot/scene_store.h"

namespace camway::messages {

/// Conversions of scenes to messages. Texts that are too long for the wire are clipped.

scene_info_t scene_info_of(const scene::Snapshot& snapshot);

scene_object_t object_on_wire(const scene::SceneObject& object);

scene_change_t change_on_wire(const scene::KeptRevision& kept);

}  // namespace camway::messages
