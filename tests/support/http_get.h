// SPDX-License-Identifier: MIT
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <string>

namespace camway::testing {

/// A TCP connection to a port of this machine, for arbitrary bytes.
class LocalConnection {
 public:
  explicit LocalConnection(int port) : fd_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const timeval patience{30, 0};
    setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    good_ = connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~LocalConnection() { close(fd_); }
  LocalConnection(const LocalConnection&) = delete;
  LocalConnection& operator=(const LocalConnection&) = delete;

  [[nodiscard]] bool good() const { return good_; }
  bool send(const std::string& text) const {
    return ::send(fd_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }
  /// Lets the other side know that nothing more comes.
  void end_sending() const { shutdown(fd_, SHUT_WR); }
  /// Returns whether bytes or the end of the connection come within `timeout_s`.
  [[nodiscard]] bool has_something(double timeout_s) const {
    pollfd input{fd_, POLLIN, 0};
    return poll(&input, 1, static_cast<int>(timeout_s * 1e3)) > 0;
  }
  /// Returns whether the other side closes the connection; ignores received bytes.
  [[nodiscard]] bool ends() const {
    std::array<char, 4096> part{};
    ssize_t got = 0;
    do got = recv(fd_, part.data(), part.size(), 0);
    while (got > 0);
    return got == 0 || errno == ECONNRESET;
  }
  /// Returns all bytes until the other side closes.
  [[nodiscard]] std::string receive() const {
    std::string all;
    std::array<char, 4096> part{};
    for (ssize_t got = 0; (got = recv(fd_, part.data(), part.size(), 0)) > 0;) {
      all.append(part.data(), static_cast<std::size_t>(got));
    }
    return all;
  }

 private:
  int fd_;
  bool good_ = false;
};

/// Returns the answer to an HTTP request, head and body; empty if there is none.
inline std::string http_request(int port, const std::string& method, const std::string& path) {
  const LocalConnection connection(port);
  const std::string request =
      method + " " + path + " HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n";
  return connection.good() && connection.send(request) ? connection.receive() : std::string();
}

/// Returns the body of an HTTP answer.
inline std::string body_of(const std::string& answer) {
  const std::size_t end = answer.find("\r\n\r\n");
  return end == std::string::npos ? std::string() : answer.substr(end + 4);
}

}  // namespace camway::testing
