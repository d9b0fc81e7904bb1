// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace camway::service {

/// Carrier of messages: LCM in the daemon, memory in tests.
/// Not thread-safe, except for `wake`: one thread subscribes, publishes and polls, since not every
/// LCM provider takes calls from several (lcm-proj/lcm issue 614).
class Transport {
 public:
  /// `message` is valid during the call.
  using Handler = std::function<void(std::span<const std::uint8_t> message)>;

  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  /// Calls `handler` from `poll` for each message on exactly `channel`. Up to `queue_capacity`
  /// messages wait for a call of `poll`; when it is full the newest are lost. A handler must not
  /// throw; if it does, the message is dropped and the exception ends there.
  /// Returns whether the subscription is in place.
  [[nodiscard]] virtual bool subscribe(const std::string& channel, int queue_capacity,
                                       Handler handler) = 0;

  /// Sends a message. Success does not mean that anyone received it.
  [[nodiscard]] virtual bool publish(const std::string& channel,
                                     std::span<const std::uint8_t> message) = 0;

  /// Waits until a message arrives, `wake` is called or `timeout` passes; then calls the handlers
  /// for the messages that are there, up to a bounded number. Returns false if the transport is
  /// broken for good.
  [[nodiscard]] virtual bool poll(std::chrono::milliseconds timeout) = 0;

  /// Ends a wait in `poll`, or the next one. May be called from a signal handler.
  /// Thread-safe.
  virtual void wake() noexcept = 0;
};

}  // namespace camway::service
