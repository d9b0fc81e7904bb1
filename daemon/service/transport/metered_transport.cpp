// SPDX-License-Identifier: MIT
#include "daemon/service/transport/metered_transport.h"

#include <utility>

namespace camway::service {

bool MeteredTransport::subscribe(const std::string& channel, int queue_capacity, Handler handler) {
  return inner_.subscribe(
      channel, queue_capacity,
      [this, handler = std::move(handler)](std::span<const std::uint8_t> message) {
        ++traffic_.received_messages;
        traffic_.received_bytes += static_cast<std::int64_t>(message.size());
        handler(message);
      });
}

bool MeteredTransport::publish(const std::string& channel, std::span<const std::uint8_t> message) {
  if (!inner_.publish(channel, message)) {
    ++traffic_.unsent_messages;
    return false;
  }
  ++traffic_.sent_messages;
  traffic_.sent_bytes += static_cast<std::int64_t>(message.size());
  return true;
}

}  // namespace camway::service
