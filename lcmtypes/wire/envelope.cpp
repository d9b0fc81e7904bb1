// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/envelope.h"

#include "lcmtypes/wire/check.h"

namespace camway::wire {

// An envelope adds fingerprint, key id, sender, counter, time, tag and the count of the payload. A
// message of the largest size fits.
constexpr std::size_t kEnvelopeHeadBytes =
    8 + sizeof(std::int32_t) + 3 * sizeof(std::int64_t) + sizeof(envelope_t::tag) + 4;
static_assert(kMaxMessageBytes + kEnvelopeHeadBytes <= kMaxEnvelopeBytes);

bool is_envelope(std::span<const std::uint8_t> message) {
  const auto fingerprint = static_cast<std::uint64_t>(envelope_t::getHash());
  if (message.size() < sizeof fingerprint) return false;
  std::uint64_t read = 0;
  for (const std::uint8_t byte : message.first(sizeof fingerprint)) read = (read << 8U) | byte;
  return read == fingerprint;
}

std::optional<std::vector<std::uint8_t>> payload_unchecked(std::span<const std::uint8_t> message) {
  if (!is_envelope(message)) return std::vector<std::uint8_t>(message.begin(), message.end());
  Decoded<envelope_t> decoded = decode<envelope_t>(message);
  if (!decoded.message) return std::nullopt;
  return std::move(decoded.message->payload);
}

}  // namespace camway::wire
