// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace camway::nats {

/// A subscription; ends when it is destroyed. Its handler does not run any more once the
/// destructor has returned.
class Subscription {
 public:
  virtual ~Subscription() = default;
};

/// Messages between processes by subject: at most once, in order between one sender and one
/// receiver. Thread-safe.
class Bus {
 public:
  /// Called on threads of the bus, never on two at a time for one subscription. Must not block for
  /// long, and must not throw.
  using Handler =
      std::function<void(const std::string& subject, std::span<const std::uint8_t> payload)>;

  virtual ~Bus() = default;

  /// Sends a message. Returns false if it cannot be sent now; if true, it may still be lost.
  /// Requires at most `most_bytes` of payload.
  virtual bool publish(const std::string& subject, std::span<const std::uint8_t> payload) = 0;

  /// Receives the messages of a subject, which may end in the wildcard `>`. Returns null if that is
  /// not possible. Stays subscribed when the connection is lost and made again.
  virtual std::unique_ptr<Subscription> subscribe(const std::string& subject, Handler handler) = 0;

  [[nodiscard]] virtual bool is_connected() const = 0;
  [[nodiscard]] virtual std::size_t most_bytes() const = 0;
};

}  // namespace camway::nats
