// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <camway/scene_request_t.hpp>

#include "daemon/service/core/answer_cache.h"

namespace camway::service {

/// Returns the digest of all that a request asks for: `utime` does not count.
RequestDigest digest_of(scene_request_t request);

/// Returns a name that is equal for repetitions of a request only (`scene::ChangeNote::request`). A
/// client that begins its ids anew has other names for other requests.
std::string request_name(const scene_request_t& request);

}  // namespace camway::service
