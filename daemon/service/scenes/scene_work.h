// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <camway/scene_request_t.hpp>
#include <camway/scene_response_t.hpp>

#include "daemon/service/scenes/scene_context.h"
#include "daemon/service/scenes/uploads.h"

namespace camway::service {

/// An answer with nothing in it but ids, status and message.
scene_response_t plain_scene_answer(const scene_request_t& request, std::int32_t status,
                                    std::string_view message);

/// Whether the operation only looks: then it may be done again at any time.
bool only_looks(const scene_request_t& request);

/// The scene that the operation changes, or looks at.
const std::string& target_of(const scene_request_t& request);

/// One word.
const char* operation_name(const scene_request_t& request);

/// What came of a request.
struct Performed {
  scene_response_t answer;
  std::vector<std::uint8_t> map;  ///< of an export that goes to the client
};

/// Does what a request asks for and says how it went; a file or an upload is read by the import
/// process. `upload` is the one that the request names, null if it is not there. `utime` is left 0.
/// What is called off fails; what it says of that is for nobody.
/// For a thread that has time: a file may take as long as its import may. Safe from any thread; the
/// changes of one scene are to be asked for one after the other, or one that was made meanwhile may
/// be lost.
Performed perform(const scene_request_t& request, const UploadedBytes& upload,
                  const SceneContext& context);

}  // namespace camway::service
