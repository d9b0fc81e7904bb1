// SPDX-License-Identifier: MIT
#pragma once

#include <camway/body.h>

#include <optional>
#include <string>

#include <camway/body_t.hpp>

namespace camway {

/// Why `body` has no form on the wire: too many points or triangles. Values are for the daemon to
/// judge.
std::optional<std::string> fault_in_form(const Body& body);

/// Precondition: no `fault_in_form`.
body_t to_wire(const Body& body);

}  // namespace camway
