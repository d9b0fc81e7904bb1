// SPDX-License-Identifier: MIT
#include "daemon/service/local_traffic.h"

#include <fmt/format.h>
#include <linux/filter.h>
#include <linux/if_packet.h>
#include <net/if_arp.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace camway::service {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kProvider = "udpm://";
constexpr int kDefaultPort = 7667;  ///< LCM's

/// What follows `name=` among the options of a URL; empty if it is not there.
std::string option(std::string_view options, std::string_view name) {
  while (!options.empty()) {
    const std::string_view one = options.substr(0, options.find('&'));
    if (one.starts_with(name) && one.substr(name.size()).starts_with('=')) {
      return std::string(one.substr(name.size() + 1));
    }
    options.remove_prefix(std::min(options.size(), one.size() + 1));
  }
  return {};
}

bool is_bound_to(int socket, int port) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  if (::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) return false;
  int type = 0;
  socklen_t type_size = sizeof type;
  return address.sin_family == AF_INET && ntohs(address.sin_port) == port &&
         ::getsockopt(socket, SOL_SOCKET, SO_TYPE, &type, &type_size) == 0 && type == SOCK_DGRAM;
}

/// Lets pass what the kernel looped back on its way out, and what came by the loopback device. No
/// other host can make its packets look like that.
bool attach_filter(int socket) {
  constexpr auto kPacketType = static_cast<std::uint32_t>(SKF_AD_OFF + SKF_AD_PKTTYPE);
  constexpr auto kDeviceType = static_cast<std::uint32_t>(SKF_AD_OFF + SKF_AD_HATYPE);
  std::array<sock_filter, 6> program{{
      {BPF_LD | BPF_W | BPF_ABS, 0, 0, kPacketType},
      {BPF_JMP | BPF_JEQ | BPF_K, 3, 0, PACKET_LOOPBACK},  // to the last
      {BPF_LD | BPF_W | BPF_ABS, 0, 0, kDeviceType},
      {BPF_JMP | BPF_JEQ | BPF_K, 1, 0, ARPHRD_LOOPBACK},  // to the last
      {BPF_RET | BPF_K, 0, 0, 0},                          // drop
      {BPF_RET | BPF_K, 0, 0, UINT32_MAX},                 // all of it
  }};
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  return ::setsockopt(socket, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) == 0;
}

}  // namespace

std::optional<int> port_of_local_network(std::string_view url) {
  if (!url.starts_with(kProvider)) return std::nullopt;
  url.remove_prefix(kProvider.size());
  const std::string_view host = url.substr(0, url.find('?'));
  const std::string_view options = url.substr(std::min(url.size(), host.size() + 1));
  // As LCM reads it: what is no number is 0, and what is too large is cut.
  const long ttl = std::strtol(option(options, "ttl").c_str(), nullptr, 0);
  if (static_cast<std::uint8_t>(ttl) != 0) return std::nullopt;
  const std::size_t colon = host.find(':');
  if (colon == std::string_view::npos) return kDefaultPort;
  return std::atoi(std::string(host.substr(colon + 1)).c_str());
}

std::string hear_this_host_only(int port) {
  std::error_code failed;
  int sockets = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc/self/fd", failed)) {
    const int socket = std::atoi(entry.path().filename().c_str());
    if (!is_bound_to(socket, port)) continue;
    if (!attach_filter(socket)) return std::generic_category().message(errno);
    ++sockets;
  }
  if (failed) return "/proc/self/fd: " + failed.message();
  return sockets > 0 ? "" : fmt::format("no socket is bound to UDP port {}", port);
}

}  // namespace camway::service
