// SPDX-License-Identifier: MIT
#include "daemon/service/transport/auth_transport.h"

#include <utility>

namespace camway::service {

AuthTransport::AuthTransport(Transport& inner, std::shared_ptr<wire::MessageAuth> auth,
                             bool required, LimitedLog log)
    : inner_(inner), auth_(std::move(auth)), required_(required), log_(std::move(log)) {}

bool AuthTransport::subscribe(const std::string& channel, int queue_capacity, Handler handler) {
  return inner_.subscribe(
      channel, queue_capacity,
      [this, channel, handler = std::move(handler)](std::span<const std::uint8_t> message) {
        take(channel, message, handler);
      });
}

bool AuthTransport::publish(const std::string& channel, std::span<const std::uint8_t> message) {
  return inner_.publish(channel, auth_->seal(channel, message));
}

void AuthTransport::take(const std::string& channel, std::span<const std::uint8_t> message,
                         const Handler& handler) {
  const wire::MessageAuth::Opened opened = auth_->open(channel, message);
  if (opened.message) {
    handler(*opened.message);
    return;
  }
  ++distrusted_.at(static_cast<std::size_t>(opened.why));
  if (opened.why == wire::Distrust::kUnsigned && !required_) {
    handler(message);
    return;
  }
  log_.write(
      "distrusted message",
      {{"channel", channel}, {"bytes", message.size()}, {"reason", wire::to_string(opened.why)}});
}

}  // namespace camway::service
