// SPDX-License-Identifier: MIT
#include <camway/authentication.h>

#include <cmath>
#include <utility>

#include "lcmtypes/wire/auth/message_auth.h"

namespace camway {
namespace {

constexpr double kMicrosecondsPerSecond = 1e6;
constexpr double kLongestWindow_s = 86'400.0;

class KeySession final : public Authentication::Session {
 public:
  KeySession(std::shared_ptr<const wire::MessageKeys> keys, const wire::ReplayGuard::Limits& limits)
      : auth_(std::move(keys), limits) {}

  Authentication::Bytes seal(const std::string& channel,
                             const Authentication::Bytes& message) override {
    return auth_.seal(channel, message);
  }
  std::optional<Authentication::Bytes> open(const std::string& channel, const std::uint8_t* message,
                                            std::size_t size) override {
    return auth_.open(channel, {message, size}).message;
  }

 private:
  wire::MessageAuth auth_;
};

class KeyAuthentication final : public Authentication {
 public:
  KeyAuthentication(std::shared_ptr<const wire::MessageKeys> keys,
                    const wire::ReplayGuard::Limits& limits)
      : keys_(std::move(keys)), limits_(limits) {}

  std::unique_ptr<Session> begin() const override {
    return std::make_unique<KeySession>(keys_, limits_);
  }

 private:
  const std::shared_ptr<const wire::MessageKeys> keys_;
  const wire::ReplayGuard::Limits limits_;
};

}  // namespace

LoadedAuthentication authentication_from(const std::string& key_file, double window_s) {
  if (!(window_s > 0.0) || !(window_s <= kLongestWindow_s)) {
    return {nullptr, "window_s: must be above 0 and at most 86400"};
  }
  wire::MessageKeys::ReadResult read = wire::MessageKeys::from_file(key_file);
  if (!read.keys) return {nullptr, std::move(read.error)};
  wire::ReplayGuard::Limits limits;
  // A client lives briefly, and the daemon's clock may be behind, so messages from before its start
  // are accepted. Old answers cannot harm it, because no other client has its id.
  limits.only_since_start = false;
  limits.window_us = std::llround(window_s * kMicrosecondsPerSecond);
  return {std::make_shared<const KeyAuthentication>(std::move(read.keys), limits), {}};
}

}  // namespace camway
