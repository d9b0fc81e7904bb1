// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <camway/scene_request_t.hpp>

#include "camway/scene.h"
#include "client/session.h"

namespace camway {

/// Sends `upload` first, if there is one, then asks for what `request` says; client and request id
/// are set here. Preconditions as those of the calls in session.h.
SceneAnswer ask_scene(Session& session, scene_request_t request,
                      const std::vector<std::uint8_t>& upload = {});

/// Asks for a list until all of it is here.
SceneAnswer ask_scene_list(Session& session, scene_request_t request);

}  // namespace camway
