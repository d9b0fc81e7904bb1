// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lcmtypes/wire/layout.h"

namespace camway::wire {

/// What is wrong with the bytes of a message.
struct Fault {
  std::string field;   ///< e.g. "scenes[3].name"; empty where the message as a whole is at fault
  std::string reason;  ///< e.g. "length -5 is below 1"

  /// One sentence without a full stop, e.g. "plan_request_t.scene: length -5 is below 1".
  [[nodiscard]] std::string text(std::string_view type) const;
};

/// Whether a message was refused for its fingerprint: it is of another type, or of this one in
/// another version of Camway.
[[nodiscard]] bool is_other_version(const Fault& fault);

/// Checks everything that the decoder of lcm-gen takes on trust: fingerprint, length of every
/// string (at least the final NUL, which must be there, and no other), count of every list against
/// the bytes that are left, and the exact size of the whole. The decoder throws or takes gigabytes
/// on a message of 76 bytes that fails this. Values are not judged. Allocates nothing unless it
/// finds a fault. Safe from any thread.
[[nodiscard]] std::optional<Fault> check(const Layout& layout, std::span<const std::uint8_t> bytes);

/// Who sent a request.
struct Sender {
  std::string client_id;
  std::int64_t request_id = 0;
};

/// Reads the sender of a request of type `layout` as far as the bytes allow, for the answer to a
/// message that fails `check`. Nothing unless fingerprint and client id are right.
/// Precondition: the type begins with client_id and request_id.
[[nodiscard]] std::optional<Sender> peek_sender(const Layout& layout,
                                                std::span<const std::uint8_t> bytes);

/// A message, or what is wrong with its bytes.
template <class Message>
struct Decoded {
  std::optional<Message> message;
  Fault fault;  ///< meaningful when `message` is empty
};

/// Checks, then decodes. Takes no more than a few times the size of `bytes` in memory.
template <class Message>
[[nodiscard]] Decoded<Message> decode(std::span<const std::uint8_t> bytes) {
  if (std::optional<Fault> fault = check(layout_of<Message>(), bytes)) {
    return {std::nullopt, std::move(*fault)};
  }
  Decoded<Message> result{std::make_optional<Message>(), {}};
  const int size = static_cast<int>(bytes.size());
  if (result.message->decode(bytes.data(), 0, size) != size) {
    return {std::nullopt, {"", "the decoder disagrees with the check"}};
  }
  return result;
}

/// The bytes of `message`. Precondition: its counts agree with its lists.
template <class Message>
[[nodiscard]] std::vector<std::uint8_t> encode(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

}  // namespace camway::wire
