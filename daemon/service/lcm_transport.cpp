// SPDX-License-Identifier: MIT
#include "daemon/service/lcm_transport.h"

#include <lcm/lcm.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <utility>
#include <vector>

#include "lcmtypes/local_traffic.h"

namespace camway::service {
namespace {

/// So that a flood of messages cannot keep the loop from publishing.
constexpr int kMaxMessagesPerPoll = 64;

/// A file descriptor that is closed once.
class EventFd {
 public:
  EventFd() : fd_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}
  ~EventFd() {
    if (fd_ >= 0) close(fd_);
  }
  EventFd(const EventFd&) = delete;
  EventFd& operator=(const EventFd&) = delete;

  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

struct LcmDestroy {
  void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
};

class LcmTransport final : public Transport {
 public:
  LcmTransport(const std::string& url, std::function<void(const std::string&)> warn)
      : local_(url), lcm_(lcm_create(url.c_str())), warn_(std::move(warn)) {}

  [[nodiscard]] bool good() const { return lcm_ != nullptr && wake_.get() >= 0; }

  bool subscribe(const std::string& channel, int queue_capacity, Handler handler) override {
    handlers_.push_back(std::make_unique<Handler>(std::move(handler)));
    lcm_subscription_t* subscription = lcm_subscribe(
        lcm_.get(), channel.c_str(), &LcmTransport::on_message, handlers_.back().get());
    if (subscription == nullptr) return false;
    stay_local();
    return lcm_subscription_set_queue_capacity(subscription, queue_capacity) == 0;
  }

  bool publish(const std::string& channel, std::span<const std::uint8_t> message) override {
    return lcm_publish(lcm_.get(), channel.c_str(), message.data(),
                       static_cast<unsigned int>(message.size())) == 0;
  }

  bool poll(std::chrono::milliseconds timeout) override {
    std::array<pollfd, 2> fds{pollfd{lcm_get_fileno(lcm_.get()), POLLIN, 0},
                              pollfd{wake_.get(), POLLIN, 0}};
    const int ready = ::poll(fds.data(), fds.size(), static_cast<int>(timeout.count()));
    if (ready < 0) return errno == EINTR;
    if ((fds[1].revents & POLLIN) != 0) clear_wake();
    if ((fds[0].revents & (POLLERR | POLLNVAL)) != 0) return false;
    if ((fds[0].revents & POLLIN) == 0) return true;
    for (int i = 0; i < kMaxMessagesPerPoll; ++i) {
      const int handled = lcm_handle_timeout(lcm_.get(), 0);
      if (handled < 0) return false;
      if (handled == 0) break;
    }
    return true;
  }

  void wake() noexcept override {
    const std::uint64_t one = 1;
    // A full counter wakes as well as one more does, so the result does not matter.
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

  /// LCM makes the socket that it hears with at the first subscription.
  void stay_local() {
    if (handlers_.size() > 1) return;
    const std::string fault = local_.guard();
    if (!fault.empty() && warn_) warn_(fault);
  }

  void clear_wake() const {
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t got = read(wake_.get(), &count, sizeof count);
  }

  const wire::LocalTraffic local_;  ///< made before LCM is
  std::unique_ptr<lcm_t, LcmDestroy> lcm_;
  EventFd wake_;
  std::function<void(const std::string&)> warn_;
  std::vector<std::unique_ptr<Handler>> handlers_;  ///< LCM holds their addresses
};

}  // namespace

OpenedTransport open_lcm_transport(const std::string& url,
                                   std::function<void(const std::string&)> warn) {
  auto transport = std::make_unique<LcmTransport>(url, std::move(warn));
  if (!transport->good()) return {nullptr, "LCM cannot open '" + url + "'. " + multicast_hint()};
  return {std::move(transport), {}};
}

std::string multicast_hint() {
  return "If the machine has no route for multicast, this gives it one on the loopback: "
         "sudo ip link set lo multicast on && sudo ip route add 224.0.0.0/4 dev lo";
}

}  // namespace camway::service
