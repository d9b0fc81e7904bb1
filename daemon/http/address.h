// SPDX-License-Identifier: MIT
#pragma once

#include <sys/socket.h>

#include <optional>
#include <string>

namespace camway::http {

struct Address {
  std::string ip = "127.0.0.1";  ///< IPv4 or IPv6 address of this machine
  int port = 0;                  ///< 0: any free port [Limit: 0 <= value <= 65535]
};

/// The address as system calls take it.
struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t size = 0;
};

/// Returns `address` for system calls; nothing if `address.ip` is no IPv4 or IPv6 address. Does not
/// check the range of the port, whose lower 16 bits it takes.
std::optional<SocketAddress> socket_address(const Address& address);

/// Returns whether `text` is an IPv4 or IPv6 address.
bool is_ip_address(const std::string& text);
/// Returns whether this machine could listen on `text` now, whatever the port.
bool is_address_of_this_machine(const std::string& text);

}  // namespace camway::http
