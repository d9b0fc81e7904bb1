// SPDX-License-Identifier: MIT
#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace camway::testing {

/// A stand-in for the service manager: the socket that sd_notify(3) writes to.
class NotifySocket {
 public:
  /// `name` is a path that does not exist, or "@..." for an abstract name.
  explicit NotifySocket(const std::string& name) : fd_(::socket(AF_UNIX, SOCK_DGRAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (fd_ < 0 || name.size() >= sizeof address.sun_path) throw std::runtime_error(name);
    std::copy(name.begin(), name.end(), address.sun_path);
    if (name.front() == '@') address.sun_path[0] = '\0';
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
    if (::bind(fd_, reinterpret_cast<const sockaddr*>(&address), length) != 0) {
      throw std::runtime_error("cannot bind " + name);
    }
  }
  ~NotifySocket() { ::close(fd_); }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// Returns the next message; empty if none comes in time.
  std::string next(std::chrono::milliseconds patience = std::chrono::seconds(60)) {
    pollfd ready{fd_, POLLIN, 0};
    if (::poll(&ready, 1, static_cast<int>(patience.count())) != 1) return {};
    std::array<char, 4096> buffer{};
    const ssize_t got = ::recv(fd_, buffer.data(), buffer.size(), 0);
    return got < 0 ? std::string() : std::string(buffer.data(), static_cast<std::size_t>(got));
  }

  /// Returns the next message that begins with `state`, and skips all others.
  std::string next_of(const std::string& state) {
    while (true) {
      std::string message = next();
      if (message.empty() || message.rfind(state, 0) == 0) return message;
    }
  }

 private:
  int fd_;
};

}  // namespace camway::testing
