// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "tests/messages/random_messages.h"

namespace camway::testing {

/// Changes `bytes` in one to four places: bits, bytes, 32-bit numbers of the dangerous kind, cuts,
/// insertions, repetitions.
void mutate(std::vector<std::uint8_t>& bytes, Random& random);

}  // namespace camway::testing
