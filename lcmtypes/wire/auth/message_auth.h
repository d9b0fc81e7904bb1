// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "lcmtypes/wire/auth/message_keys.h"
#include "lcmtypes/wire/auth/replay_guard.h"

namespace camway::wire {

/// The reason why a message is not trusted.
enum class Distrust : std::uint8_t {
  kUnsigned,    ///< the message is no envelope
  kBroken,      ///< the envelope cannot be read
  kUnknownKey,  ///< the envelope is signed with a key that is not known here
  kAltered,     ///< the tag is wrong: the sender has another key under this id, or the payload, the
                ///< channel or another signed member was changed
  kStale,       ///< the time of signing is outside the window
  kReplayed,    ///< the message was received before
  kCrowded,     ///< there are more senders than can be remembered
};
inline constexpr std::size_t kDistrusts = 7;

/// Returns the name of a reason, such as "unsigned" or "wrong_key_or_altered".
std::string_view to_string(Distrust why);

/// Signs the messages that a program sends and checks those that it receives. Thread-safe.
class MessageAuth {
 public:
  using Clock = std::int64_t (*)();  ///< microseconds since 1970

  /// A null `clock` stands for the system's clock.
  MessageAuth(std::shared_ptr<const MessageKeys> keys, const ReplayGuard::Limits& limits,
              Clock clock = nullptr);

  /// Returns the encoded envelope that carries `message` on `channel`.
  [[nodiscard]] std::vector<std::uint8_t> seal(std::string_view channel,
                                               std::span<const std::uint8_t> message);

  struct Opened {
    std::optional<std::vector<std::uint8_t>> message;
    Distrust why = Distrust::kUnsigned;  ///< meaningful when `message` is empty
  };
  /// Returns the payload of an envelope that came on `channel`, or the reason not to trust it.
  [[nodiscard]] Opened open(std::string_view channel, std::span<const std::uint8_t> message);

  /// Replaces the keys. The counter and the memory of received messages stay.
  void set_keys(std::shared_ptr<const MessageKeys> keys);

 private:
  const Clock clock_;
  const std::int64_t sender_;
  std::mutex mutex_;  ///< guards all below
  std::shared_ptr<const MessageKeys> keys_;
  std::int64_t counter_ = 0;
  ReplayGuard guard_;
};

/// Returns the payload of an envelope from a recording. Checks the tag, but neither age nor
/// repetition.
[[nodiscard]] MessageAuth::Opened open_recorded(const MessageKeys& keys, std::string_view channel,
                                                std::span<const std::uint8_t> message);

}  // namespace camway::wire
