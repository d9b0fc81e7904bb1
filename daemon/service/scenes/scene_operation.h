// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <camway/scene_request_t.hpp>
#include <camway/scene_response_t.hpp>

#include "daemon/service/scenes/operation_context.h"
#include "daemon/service/scenes/uploads.h"

namespace camway::service {

/// Returns whether the operation is a query: it changes no scene, and may be repeated at any time.
bool is_query(const scene_request_t& request);

/// Returns the name of the scene that the operation changes or queries.
const std::string& target_of(const scene_request_t& request);

/// Returns the operation in one word, e.g. "load".
const char* operation_name(const scene_request_t& request);

/// Result of a request.
struct SceneReply {
  scene_response_t answer;
  std::vector<std::uint8_t> map;  ///< exported map, if it goes to the client
};

/// Carries out a request and returns its answer, with `utime` 0; the import process reads a file or
/// upload. `upload` is the one that the request names, null if it is not there. If the request is
/// cancelled meanwhile, the caller must discard the reply. May take as long as the import of a
/// file. Where another process may have changed the scene, waits for its changes before a change is
/// refused because of what the scene is or has (`SceneStore::catch_up`).
///
/// Thread-safe. Concurrent changes of one scene take effect one after the other, each on what the
/// one before it left.
SceneReply execute(const scene_request_t& request, const UploadedBytes& upload,
                   const OperationContext& context);

}  // namespace camway::service
