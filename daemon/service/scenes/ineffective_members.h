// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <camway/scene_request_t.hpp>

namespace camway::service {

/// Returns a sentence for the answer that names the first member of a scene request which has a
/// value but no effect with the request's operation or kind of object. Returns an empty text if
/// there is no such member, and for unknown operations and kinds. The sender expects an effect, so
/// the caller refuses a request with such a member. Thread-safe.
std::string ineffective_member(const scene_request_t& request);

}  // namespace camway::service
