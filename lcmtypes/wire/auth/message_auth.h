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

/// Why a message is not trusted.
enum class Distrust : std::uint8_t {
  kUnsigned,    ///< no envelope
  kBroken,      ///< an envelope that cannot be read
  kUnknownKey,  ///< signed with a key that we do not have
  kAltered,     ///< the tag is not that of our key of that id: the sender has another key under it,
                ///< or payload, channel, time or whatever else is not what was signed
  kStale,       ///< too old, or from the future
  kReplayed,    ///< came before
  kCrowded,     ///< more senders than can be remembered
};
inline constexpr std::size_t kDistrusts = 7;

/// E.g. "unsigned", "wrong_key_or_altered".
std::string_view to_string(Distrust why);

/// Signs what one program sends and checks what it receives. From any thread.
class MessageAuth {
 public:
  using Clock = std::int64_t (*)();  ///< microseconds since 1970

  /// `clock`: the system's if null.
  MessageAuth(std::shared_ptr<const MessageKeys> keys, const ReplayGuard::Limits& limits,
              Clock clock = nullptr);

  /// The envelope that carries `message` on `channel`.
  [[nodiscard]] std::vector<std::uint8_t> seal(std::string_view channel,
                                               std::span<const std::uint8_t> message);

  struct Opened {
    std::optional<std::vector<std::uint8_t>> message;
    Distrust why = Distrust::kUnsigned;  ///< meaningful when `message` is empty
  };
  /// What is in an envelope that came on `channel`, if it is to be trusted.
  [[nodiscard]] Opened open(std::string_view channel, std::span<const std::uint8_t> message);

  /// From now on these keys count. What was sent or received before is not forgotten.
  void set_keys(std::shared_ptr<const MessageKeys> keys);

 private:
  const Clock clock_;
  const std::int64_t sender_;
  std::mutex mutex_;  ///< guards all below
  std::shared_ptr<const MessageKeys> keys_;
  std::int64_t counter_ = 0;
  ReplayGuard guard_;
};

/// Opens an envelope of a recording: its tag counts, its age does not.
[[nodiscard]] MessageAuth::Opened open_recorded(const MessageKeys& keys, std::string_view channel,
                                                std::span<const std::uint8_t> message);

}  // namespace camway::wire
