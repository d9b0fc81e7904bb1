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

/// A fault in the bytes of a message.
struct Fault {
  std::string field;   ///< e.g. "scenes[3].name"; empty where the message as a whole is at fault
  std::string reason;  ///< e.g. "length -5 is below 1"

  /// One sentence without a full stop, e.g. "plan_request_t.scene: length -5 is below 1".
  [[nodiscard]] std::string text(std::string_view type) const;
};

/// Returns whether a fault is a wrong fingerprint: the message has another type, or the same type
/// of another version of Camway.
[[nodiscard]] bool is_other_version(const Fault& fault);

/// Returns the first fault of a message, or nothing if lcm-gen's decoder can decode it safely. The
/// decoder itself checks none of this: the fingerprint; the length of every string, with one NUL,
/// at its end; the count of every list against the remaining bytes; and the exact size of the
/// message. Without the check, a message of 76 bytes can make the decoder throw or allocate
/// gigabytes.
///
/// Values are not checked. Allocates memory only for a fault. Thread-safe.
[[nodiscard]] std::optional<Fault> check(const Layout& layout, std::span<const std::uint8_t> bytes);

/// The sender of a request, and its id.
struct Sender {
  std::string client_id;
  std::int64_t request_id = 0;
};

/// Returns the sender of a request of type `layout`, for the answer to a message that fails
/// `check`. Returns nothing if the fingerprint or the client id is wrong. Requires a type that
/// begins with client_id and request_id.
[[nodiscard]] std::optional<Sender> peek_sender(const Layout& layout,
                                                std::span<const std::uint8_t> bytes);

/// A message, or the fault of its bytes.
template <class Message>
struct Decoded {
  std::optional<Message> message;
  Fault fault;  ///< meaningful when `message` is empty
};

/// Checks and decodes a message, by a layout of its type. Its memory is at most a few times the
/// size of `bytes`. [Limit: layout.max_bytes < 2 GB]
template <class Message>
[[nodiscard]] Decoded<Message> decode(const Layout& layout, std::span<const std::uint8_t> bytes) {
  if (std::optional<Fault> fault = check(layout, bytes)) {
    return {std::nullopt, std::move(*fault)};
  }
  Decoded<Message> result{std::make_optional<Message>(), {}};
  const int size = static_cast<int>(bytes.size());
  if (result.message->decode(bytes.data(), 0, size) != size) {
    return {std::nullopt, {"", "the decoder disagrees with the check"}};
  }
  return result;
}

template <class Message>
[[nodiscard]] Decoded<Message> decode(std::span<const std::uint8_t> bytes) {
  return decode<Message>(layout_of<Message>(), bytes);
}

/// Decodes a message that did not travel by itself, so that it may be longer than others are.
template <class Message>
[[nodiscard]] Decoded<Message> decode_within(std::size_t most_bytes,
                                             std::span<const std::uint8_t> bytes) {
  Layout layout = layout_of<Message>();
  layout.max_bytes = most_bytes;
  return decode<Message>(layout, bytes);
}

/// Returns the bytes of `message`. Requires counts that equal the lengths of their lists.
template <class Message>
[[nodiscard]] std::vector<std::uint8_t> encode(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

}  // namespace camway::wire
