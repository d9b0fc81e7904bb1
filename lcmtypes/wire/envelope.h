// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <camway/envelope_t.hpp>

namespace camway::wire {

/// Returns whether a message has the fingerprint of an envelope. Checks nothing else.
[[nodiscard]] bool is_envelope(std::span<const std::uint8_t> message);

/// Returns the content of a message for a reader without keys: the payload of an envelope, without
/// a check of its tag, or the message itself if it is no envelope. Returns nothing for an envelope
/// that cannot be read.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> payload_unchecked(
    std::span<const std::uint8_t> message);

}  // namespace camway::wire
