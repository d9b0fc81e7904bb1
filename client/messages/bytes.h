// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace camway {

/// An encoded message.
using Bytes = std::vector<std::uint8_t>;

}  // namespace camway
