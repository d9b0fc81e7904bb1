// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <camway/scene_request_t.hpp>

#include "camway/scene.h"
#include "client/context.h"
#include "client/engine.h"

namespace camway {

/// Sends `upload` first, if there is one, then asks for what `request` says; client and request id
/// are set here. Waits for the answer; not for the engine's own thread.
SceneAnswer ask_scene(Context& context, Engine& engine, scene_request_t request,
                      const std::vector<std::uint8_t>& upload = {});

/// Asks for a map until all of it is here.
SceneMap ask_scene_map(Context& context, Engine& engine, const scene_request_t& request);

/// Asks for a list until all of it is here.
SceneAnswer ask_scene_list(Context& context, Engine& engine, scene_request_t request);

}  // namespace camway
