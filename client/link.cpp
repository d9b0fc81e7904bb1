// SPDX-License-Identifier: MIT
#include "client/link.h"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <utility>

#include <lcm/lcm-cpp.hpp>

namespace camway {
namespace {

/// LCM's usual group and port; ttl 0 keeps traffic on this host unless the user asks otherwise.
constexpr const char* kDefaultUrl = "udpm://239.255.76.67:7667?ttl=0";

constexpr int kMostDrained = 10'000;

std::string url_or_default(const std::string& url) {
  if (!url.empty()) return url;
  const char* const from_environment = std::getenv("LCM_DEFAULT_URL");
  return from_environment != nullptr && *from_environment != '\0' ? from_environment : kDefaultUrl;
}

void pass_on(const lcm::ReceiveBuffer* buffer, const std::string& /*channel*/,
             Link::Handler* handler) {
  try {
    (*handler)({static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
  } catch (...) {
    // Out of memory, say. LCM's C code must not be unwound; the message is as good as lost, and
    // lost messages are asked for again.
  }
}

}  // namespace

Link::Link() = default;
Link::~Link() = default;

std::string Link::open(const std::string& url) {
  url_ = url_or_default(url);
  lcm_ = std::make_unique<lcm::LCM>(url_);
  // getFileno makes the receiving half set itself up and test itself, which is when LCM finds out.
  if (lcm_->good() && lcm_->getFileno() >= 0) return {};
  lcm_.reset();
  return "LCM cannot use " + url_ +
         ". For udpm, check that multicast has a route: ip link set lo up; ip link set lo "
         "multicast on; ip route add 224.0.0.0/4 dev lo";
}

void Link::listen(const std::string& channel, int capacity, Handler handler) {
  handlers_.push_back(std::move(handler));
  lcm::Subscription* const subscription =
      lcm_->subscribeFunction(channel, &pass_on, &handlers_.back());
  subscription->setQueueCapacity(capacity);
}

bool Link::publish(const std::string& channel, const Bytes& bytes) {
  return lcm_->publish(channel, bytes.data(), static_cast<unsigned>(bytes.size())) == 0;
}

Link::Wait Link::wait(Clock::time_point until) {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
    const int left_ms = static_cast<int>(std::clamp<long long>(left.count(), 0, 1000));
    pollfd ready{lcm_->getFileno(), POLLIN, 0};
    const int count = ::poll(&ready, 1, left_ms);
    if (count > 0) return lcm_->handle() == 0 ? Wait::kHandled : Wait::kBroken;
    if (count < 0 && errno != EINTR) return Wait::kBroken;
    if (Clock::now() >= until) return Wait::kTimeUp;
  }
}

void Link::drain() {
  // Bounded, so that somebody who floods the channels cannot keep us here.
  for (int i = 0; i < kMostDrained && wait(Clock::now()) == Wait::kHandled; ++i) {
  }
}

}  // namespace camway
