// SPDX-License-Identifier: MIT
#pragma once

#include <camway/body.h>

#include <camway/body_t.hpp>

namespace camway {

/// Writes a body: the members that its shape uses.
void put(const Body& mine, body_t& wire);

}  // namespace camway
