// SPDX-License-Identifier: MIT
#include "client/engine/lcm_connection.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <optional>
#include <utility>

#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/wire/envelope.h"
#include "lcmtypes/wire/local_traffic.h"

namespace camway {
namespace {

/// LCM's default group and port; ttl 0 keeps the traffic on this host.
constexpr const char* kDefaultUrl = "udpm://239.255.76.67:7667?ttl=0";

/// Most messages to handle in one call, so that a flood on the channels cannot block the thread.
constexpr int kMostHandled = 256;

std::string url_or_default(const std::string& url) {
  if (!url.empty()) return url;
  const char* const from_environment = std::getenv("LCM_DEFAULT_URL");
  return from_environment != nullptr && *from_environment != '\0' ? from_environment : kDefaultUrl;
}

}  // namespace

LcmConnection::LcmConnection() {
  int ends[2];
  if (::pipe2(ends, O_NONBLOCK | O_CLOEXEC) == 0) wake_ = {ends[0], ends[1]};
}

LcmConnection::~LcmConnection() {
  for (const int end : {wake_.read_end, wake_.write_end}) {
    if (end >= 0) ::close(end);
  }
}

std::string LcmConnection::open(const std::string& url) {
  url_ = url_or_default(url);
  if (wake_.read_end < 0) return "this process has no file descriptors left";
  wire::OpenedLcm opened = wire::open_lcm(url_);
  lcm_ = std::move(opened.lcm);
  warning_ = std::move(opened.unguarded);
  if (lcm_) return {};
  return "LCM cannot use " + url_ +
         ". For udpm, check that multicast has a route: ip link set lo up; ip link set lo "
         "multicast on; ip route add 224.0.0.0/4 dev lo";
}

void LcmConnection::authenticate(std::unique_ptr<Authentication::Session> session) {
  authentication_ = std::move(session);
}

void LcmConnection::on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                               Listener* listener) {
  try {
    const auto* const bytes = static_cast<const std::uint8_t*>(buffer->data);
    const auto& authentication = listener->connection->authentication_;
    const std::optional<Bytes> message =
        authentication ? authentication->open(channel, bytes, buffer->data_size)
                       : wire::payload_unchecked({bytes, buffer->data_size});
    if (message) listener->handler(*message);
  } catch (...) {
    // For example out of memory. LCM's C code must not be unwound. The message counts as lost, and
    // lost messages are asked for again.
  }
}

void LcmConnection::listen(const std::string& channel, int capacity, Handler handler) {
  listeners_.push_back({this, std::move(handler)});
  lcm::Subscription* const subscription =
      lcm_->subscribeFunction(channel, &LcmConnection::on_message, &listeners_.back());
  subscription->setQueueCapacity(capacity);
}

bool LcmConnection::publish(const std::string& channel, const Bytes& bytes) {
  const auto send = [&](const Bytes& message) {
    return lcm_->publish(channel, message.data(), static_cast<unsigned>(message.size())) == 0;
  };
  return authentication_ ? send(authentication_->seal(channel, bytes)) : send(bytes);
}

LcmConnection::Wait LcmConnection::wait(Clock::time_point until) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
  const int left_ms = static_cast<int>(std::clamp<long long>(left.count(), 0, 1000));
  // poll ignores negative descriptors.
  std::array<pollfd, 2> inputs{pollfd{wake_.read_end, POLLIN, 0},
                               pollfd{broken_ ? -1 : lcm_->getFileno(), POLLIN, 0}};
  const int ready = ::poll(inputs.data(), inputs.size(), left_ms);
  if (ready < 0 && errno != EINTR) broken_ = true;
  if ((inputs[0].revents & POLLIN) != 0) clear_wake();
  if (ready > 0 && inputs[1].revents != 0) {
    for (int i = 0; i < kMostHandled; ++i) {
      const int handled = lcm_->handleTimeout(0);
      if (handled < 0) broken_ = true;
      if (handled <= 0) break;
    }
  }
  if (broken_) return Wait::kBroken;
  return ready > 0 ? Wait::kSomething : Wait::kTimeUp;
}

void LcmConnection::wake() const {
  // If the pipe is full, the wait ends anyway.
  [[maybe_unused]] const ssize_t written = ::write(wake_.write_end, "", 1);
}

void LcmConnection::clear_wake() const {
  std::array<char, 64> bytes;
  while (::read(wake_.read_end, bytes.data(), bytes.size()) > 0) {
  }
}

}  // namespace camway
