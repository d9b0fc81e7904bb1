// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <camway/envelope_t.hpp>

namespace camway::wire {

/// Whether a message says that it is an envelope. Looks at nothing but its fingerprint.
[[nodiscard]] bool is_envelope(std::span<const std::uint8_t> message);

/// What somebody reads who has no key: the message within an envelope, whoever signed it; any other
/// message as it is; nothing of an envelope that is broken.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> payload_unchecked(
    std::span<const std::uint8_t> message);

}  // namespace camway::wire
