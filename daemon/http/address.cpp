// SPDX-License-Identifier: MIT
#include "daemon/http/address.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <cstdint>

#include "daemon/base/file_descriptor.h"

namespace camway::http {

std::optional<SocketAddress> socket_address(const Address& address) {
  SocketAddress made;
  auto* const v4 = reinterpret_cast<sockaddr_in*>(&made.storage);
  auto* const v6 = reinterpret_cast<sockaddr_in6*>(&made.storage);
  const auto port = htons(static_cast<std::uint16_t>(address.port));
  if (inet_pton(AF_INET, address.ip.c_str(), &v4->sin_addr) == 1) {
    v4->sin_family = AF_INET;
    v4->sin_port = port;
    made.size = sizeof *v4;
    return made;
  }
  if (inet_pton(AF_INET6, address.ip.c_str(), &v6->sin6_addr) == 1) {
    v6->sin6_family = AF_INET6;
    v6->sin6_port = port;
    made.size = sizeof *v6;
    return made;
  }
  return std::nullopt;
}

bool is_ip_address(const std::string& text) { return socket_address({text, 0}).has_value(); }

bool is_address_of_this_machine(const std::string& text) {
  const std::optional<SocketAddress> address = socket_address({text, 0});
  if (!address) return false;
  const base::FileDescriptor socket(
      ::socket(address->storage.ss_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
  return socket.is_open() &&
         bind(socket.get(), reinterpret_cast<const sockaddr*>(&address->storage), address->size) ==
             0;
}

}  // namespace camway::http
