// SPDX-License-Identifier: MIT
#include "tests/messages/message_mutation.h"

#include <algorithm>
#include <array>
#include <limits>

namespace camway::testing {

void mutate(std::vector<std::uint8_t>& bytes, Random& random) {
  constexpr std::array<std::int32_t, 10> kDangerous{-1,
                                                    0,
                                                    1,
                                                    -5,
                                                    2,
                                                    65,
                                                    100'000,
                                                    200'000'000,
                                                    std::numeric_limits<std::int32_t>::max(),
                                                    std::numeric_limits<std::int32_t>::min()};
  const std::size_t changes = 1 + below(random, 4);
  for (std::size_t i = 0; i < changes; ++i) {
    if (bytes.empty()) bytes.push_back(0);
    const std::size_t at = below(random, bytes.size());
    const auto position = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    switch (below(random, 6)) {
      case 0:
        bytes[at] ^= static_cast<std::uint8_t>(1U << below(random, 8));
        break;
      case 1:
        bytes[at] = static_cast<std::uint8_t>(random());
        break;
      case 2: {
        // Half of these are early in the message, which has the strings and counts.
        const std::size_t where =
            below(random, 2) == 0 ? below(random, std::min(bytes.size(), std::size_t{200})) : at;
        const auto value = static_cast<std::uint32_t>(kDangerous[below(random, kDangerous.size())]);
        for (std::size_t b = 0; b < 4 && where + b < bytes.size(); ++b) {
          bytes[where + b] = static_cast<std::uint8_t>(value >> (24 - 8 * b));
        }
        break;
      }
      case 3:
        bytes.resize(at);
        break;
      case 4:
        bytes.insert(position, 1 + below(random, 16), static_cast<std::uint8_t>(random()));
        break;
      default: {
        const std::vector<std::uint8_t> copy(position, bytes.end());
        bytes.insert(bytes.end(), copy.begin(), copy.end());
        break;
      }
    }
  }
}

}  // namespace camway::testing
