// SPDX-License-Identifier: MIT
#include "daemon/record/recording_transport.h"

#include <utility>

namespace camway::record {

bool RecordingTransport::subscribe(const std::string& channel, int queue_capacity,
                                   Handler handler) {
  return inner_.subscribe(
      channel, queue_capacity,
      [this, channel, handler = std::move(handler)](std::span<const std::uint8_t> message) {
        recorder_.message(channel, message);
        handler(message);
      });
}

bool RecordingTransport::publish(const std::string& channel,
                                 std::span<const std::uint8_t> message) {
  if (!inner_.publish(channel, message)) return false;
  recorder_.message(channel, message);
  return true;
}

}  // namespace camway::record
