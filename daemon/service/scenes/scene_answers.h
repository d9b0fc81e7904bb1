// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

#include <camway/scene_request_t.hpp>
#include <camway/scene_response_t.hpp>

#include "daemon/scene/snapshot/scene_store.h"

namespace camway::service {

/// Returns an answer that holds only ids, status and message.
scene_response_t plain_scene_answer(const scene_request_t& request, std::int32_t status,
                                    std::string_view message);

/// Returns the answer to a request about a scene that is not there.
scene_response_t unknown_scene_answer(const scene_request_t& request,
                                      const scene::SceneStore& scenes);

/// Returns the answer to LIST: the scenes from `request.first` on, as many as fit into a message.
scene_response_t scene_list(const scene_request_t& request, const scene::SceneStore& scenes);

/// Returns the answer to DESCRIBE: the scene, and its objects from `request.first` on, as many as
/// fit into a message.
scene_response_t scene_description(const scene_request_t& request, const scene::SceneStore& scenes);

/// Returns the answer to HISTORY: the scene, and the revisions that can be restored from
/// `request.first` on, as many as fit into a message.
scene_response_t scene_history(const scene_request_t& request, const scene::SceneStore& scenes);

}  // namespace camway::service
