// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <camway/scene_request_t.hpp>

namespace camway::service {

/// Names the first member of a scene request that has a value but no effect with the request's
/// operation or kind of object, in a sentence for the answer: its sender meant it. Empty if there
/// is none, and for unknown operations and kinds.
std::string idle_member(const scene_request_t& request);

}  // namespace camway::service
