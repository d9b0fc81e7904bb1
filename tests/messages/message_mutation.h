// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "tests/messages/random_messages.h"

namespace camway::testing {

/// Changes `bytes` in one to four places: a bit, a byte, an extreme 32-bit number, a cut, an
/// insertion or a repetition.
void mutate(std::vector<std::uint8_t>& bytes, Random& random);

}  // namespace camway::testing
