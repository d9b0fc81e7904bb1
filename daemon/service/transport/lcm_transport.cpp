// SPDX-License-Identifier: MIT
#include "daemon/service/transport/lcm_transport.h"

#include <lcm/lcm.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <utility>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "daemon/base/file_descriptor.h"
#include "lcmtypes/wire/local_traffic.h"

namespace camway::service {
namespace {

/// Limits a round, so that a flood of messages cannot keep the loop from publishing.
constexpr int kMaxMessagesPerPoll = 64;

class LcmTransport final : public Transport {
 public:
  explicit LcmTransport(std::unique_ptr<lcm::LCM> lcm) : lcm_(std::move(lcm)) {}

  [[nodiscard]] bool good() const { return wake_.is_open(); }

  bool subscribe(const std::string& channel, int queue_capacity, Handler handler) override {
    handlers_.push_back(std::make_unique<Handler>(std::move(handler)));
    lcm_subscription_t* subscription =
        lcm_subscribe(c_lcm(), channel.c_str(), &LcmTransport::on_message, handlers_.back().get());
    return subscription != nullptr &&
           lcm_subscription_set_queue_capacity(subscription, queue_capacity) == 0;
  }

  bool publish(const std::string& channel, std::span<const std::uint8_t> message) override {
    return lcm_publish(c_lcm(), channel.c_str(), message.data(),
                       static_cast<unsigned int>(message.size())) == 0;
  }

  bool poll(std::chrono::milliseconds timeout) override {
    std::array<pollfd, 2> fds{pollfd{lcm_get_fileno(c_lcm()), POLLIN, 0},
                              pollfd{wake_.get(), POLLIN, 0}};
    const int ready = ::poll(fds.data(), fds.size(), static_cast<int>(timeout.count()));
    if (ready < 0) return errno == EINTR;
    if ((fds[1].revents & POLLIN) != 0) clear_wake();
    if ((fds[0].revents & (POLLERR | POLLNVAL)) != 0) return false;
    if ((fds[0].revents & POLLIN) == 0) return true;
    for (int i = 0; i < kMaxMessagesPerPoll; ++i) {
      const int handled = lcm_handle_timeout(c_lcm(), 0);
      if (handled < 0) return false;
      if (handled == 0) break;
    }
    return true;
  }

  void wake() noexcept override {
    const std::uint64_t one = 1;
    // A full counter wakes as well as another increment, so the result does not matter.
    [[maybe_unused]] const ssize_t written = write(wake_.get(), &one, sizeof one);
  }

 private:
  static void on_message(const lcm_recv_buf_t* buffer, const char* /*channel*/, void* user) {
    try {
      (*static_cast<Handler*>(user))(
          {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
    } catch (...) {
      // An exception in lcm_handle leaves LCM thinking that it is still in a handler (issue 164).
      // Our handlers catch their own and log them; nothing is known here that they do not know.
    }
  }

  [[nodiscard]] lcm_t* c_lcm() const { return lcm_->getUnderlyingLCM(); }

  void clear_wake() const {
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t got = read(wake_.get(), &count, sizeof count);
  }

  std::unique_ptr<lcm::LCM> lcm_;
  base::FileDescriptor wake_{eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};
  std::vector<std::unique_ptr<Handler>> handlers_;  ///< LCM holds their addresses
};

}  // namespace

base::Result<std::unique_ptr<Transport>> open_lcm_transport(
    const std::string& url, const std::function<void(const std::string&)>& warn) {
  wire::OpenedLcm opened = wire::open_lcm(url);
  if (!opened.lcm) return base::Failure{"LCM cannot open '" + url + "'. " + multicast_hint()};
  if (!opened.unguarded.empty() && warn) warn(opened.unguarded);
  auto transport = std::make_unique<LcmTransport>(std::move(opened.lcm));
  if (!transport->good()) return base::Failure{"this process has no file descriptors left"};
  return std::unique_ptr<Transport>(std::move(transport));
}

std::string multicast_hint() {
  return "If the machine has no route for multicast, this gives it one on the loopback: "
         "sudo ip link set lo multicast on && sudo ip route add 224.0.0.0/4 dev lo";
}

}  // namespace camway::service
