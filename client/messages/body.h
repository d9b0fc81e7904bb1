// SPDX-License-Identifier: MIT
#pragma once

#include <camway/body.h>

#include <optional>
#include <string>

#include <camway/body_t.hpp>

namespace camway {

/// Returns the fault of a body that cannot be sent (too many points or triangles), or nothing. The
/// daemon checks the values.
std::optional<std::string> fault_in_form(const Body& body);

/// Returns the body as it is sent. Requires a body without `fault_in_form`.
body_t to_wire(const Body& body);

}  // namespace camway
