// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>

#include "daemon/service/log/limited_log.h"
#include "daemon/service/transport/transport.h"
#include "lcmtypes/wire/auth/message_auth.h"

namespace camway::service {

/// A transport that signs all outgoing messages. It drops incoming messages without a valid
/// signature, counts them, and logs them within limits.
///
/// Not thread-safe, except for `wake`: all other calls come from the thread that owns the
/// transport.
class AuthTransport final : public Transport {
 public:
  /// The number of messages that were not trusted, for each `wire::Distrust`, which is the index.
  using Distrusted = std::array<std::int64_t, wire::kDistrusts>;

  /// `inner` must outlive this. If signatures are not `required`, unsigned messages are counted and
  /// delivered all the same.
  AuthTransport(Transport& inner, std::shared_ptr<wire::MessageAuth> auth, bool required,
                LimitedLog log);

  [[nodiscard]] bool subscribe(const std::string& channel, int queue_capacity,
                               Handler handler) override;
  [[nodiscard]] bool publish(const std::string& channel,
                             std::span<const std::uint8_t> message) override;
  [[nodiscard]] bool poll(std::chrono::milliseconds timeout) override {
    return inner_.poll(timeout);
  }
  void wake() noexcept override { inner_.wake(); }

  /// Returns the numbers since this object was made.
  [[nodiscard]] const Distrusted& distrusted() const { return distrusted_; }
  /// Logs how many lines were suppressed (`LimitedLog::report_suppressed`).
  void report_suppressed() { log_.report_suppressed(); }

 private:
  void take(const std::string& channel, std::span<const std::uint8_t> message,
            const Handler& handler);

  Transport& inner_;
  const std::shared_ptr<wire::MessageAuth> auth_;
  const bool required_;
  LimitedLog log_;
  Distrusted distrusted_{};
};

}  // namespace camway::service
