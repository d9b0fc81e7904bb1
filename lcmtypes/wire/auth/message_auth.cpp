// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/auth/message_auth.h"

#include <utility>

#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/envelope.h"
#include "lcmtypes/wire/utime.h"

namespace camway::wire {
namespace {

/// An envelope whose tag is right, or the reason why there is none.
struct Verified {
  std::optional<envelope_t> envelope;
  Distrust why = Distrust::kUnsigned;
};

Verified verified(const MessageKeys& keys, std::string_view channel,
                  std::span<const std::uint8_t> message) {
  if (!is_envelope(message)) return {std::nullopt, Distrust::kUnsigned};
  Decoded<envelope_t> decoded = decode<envelope_t>(message);
  if (!decoded.message) return {std::nullopt, Distrust::kBroken};
  switch (keys.verify(channel, *decoded.message)) {
    case MessageKeys::Verdict::kGood:
      return {std::move(decoded.message), Distrust::kUnsigned};
    case MessageKeys::Verdict::kUnknownKey:
      return {std::nullopt, Distrust::kUnknownKey};
    case MessageKeys::Verdict::kAltered:
      break;
  }
  return {std::nullopt, Distrust::kAltered};
}

}  // namespace

std::string_view to_string(Distrust why) {
  constexpr std::array<std::string_view, kDistrusts> kNames{
      "unsigned", "broken", "unknown_key", "wrong_key_or_altered", "stale", "replayed", "crowded"};
  return kNames.at(static_cast<std::size_t>(why));
}

MessageAuth::MessageAuth(std::shared_ptr<const MessageKeys> keys, const ReplayGuard::Limits& limits,
                         Clock clock)
    : clock_(clock != nullptr ? clock : &utime_now),
      sender_(MessageKeys::random_number()),
      keys_(std::move(keys)),
      guard_(limits, clock_()) {}

std::vector<std::uint8_t> MessageAuth::seal(std::string_view channel,
                                            std::span<const std::uint8_t> message) {
  envelope_t envelope{};
  envelope.sender = sender_;
  envelope.utime = clock_();
  envelope.payload.assign(message.begin(), message.end());
  envelope.num_bytes = static_cast<std::int32_t>(message.size());
  std::shared_ptr<const MessageKeys> keys;
  {
    const std::lock_guard lock(mutex_);
    envelope.counter = ++counter_;
    keys = keys_;
  }
  keys->sign(channel, envelope);
  return encode(envelope);
}

MessageAuth::Opened MessageAuth::open(std::string_view channel,
                                      std::span<const std::uint8_t> message) {
  const std::lock_guard lock(mutex_);
  Verified result = verified(*keys_, channel, message);
  if (!result.envelope) return {std::nullopt, result.why};
  switch (guard_.take(*result.envelope, clock_())) {
    case ReplayGuard::Verdict::kNew:
      return {std::move(result.envelope->payload), Distrust::kUnsigned};
    case ReplayGuard::Verdict::kStale:
      return {std::nullopt, Distrust::kStale};
    case ReplayGuard::Verdict::kReplayed:
      return {std::nullopt, Distrust::kReplayed};
    case ReplayGuard::Verdict::kCrowded:
      break;
  }
  return {std::nullopt, Distrust::kCrowded};
}

void MessageAuth::set_keys(std::shared_ptr<const MessageKeys> keys) {
  const std::lock_guard lock(mutex_);
  keys_ = std::move(keys);
}

MessageAuth::Opened open_recorded(const MessageKeys& keys, std::string_view channel,
                                  std::span<const std::uint8_t> message) {
  Verified result = verified(keys, channel, message);
  if (!result.envelope) return {std::nullopt, result.why};
  return {std::move(result.envelope->payload), Distrust::kUnsigned};
}

}  // namespace camway::wire
