// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <camway/scene_request_t.hpp>

namespace camway::service {

/// Names the first member of a scene request that is neither zero nor empty though its operation,
/// or the kind of its object, does not name it, in a sentence for the answer: it was meant. Empty
/// if there is none, and of operations and kinds that do not exist.
std::string idle_member(const scene_request_t& request);

}  // namespace camway::service
