// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "daemon/service/transport/transport.h"

namespace camway::service {

/// A transport that counts the messages of another one.
/// Not thread-safe: for the thread that owns the transport.
class MeteredTransport final : public Transport {
 public:
  /// Numbers since this was made.
  struct Traffic {
    std::int64_t received_messages = 0;
    std::int64_t received_bytes = 0;
    std::int64_t sent_messages = 0;
    std::int64_t sent_bytes = 0;
    std::int64_t unsent_messages = 0;  ///< refused by the transport
  };

  /// `inner` must outlive this.
  explicit MeteredTransport(Transport& inner) : inner_(inner) {}

  [[nodiscard]] bool subscribe(const std::string& channel, int queue_capacity,
                               Handler handler) override;
  [[nodiscard]] bool publish(const std::string& channel,
                             std::span<const std::uint8_t> message) override;
  [[nodiscard]] bool poll(std::chrono::milliseconds timeout) override {
    return inner_.poll(timeout);
  }
  void wake() noexcept override { inner_.wake(); }

  [[nodiscard]] const Traffic& traffic() const { return traffic_; }

 private:
  Transport& inner_;
  Traffic traffic_;
};

}  // namespace camway::service
