// SPDX-License-Identifier: MIT
#include "lcmtypes/local_traffic.h"

#include <linux/filter.h>
#include <linux/if_packet.h>
#include <net/if_arp.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace camway::wire {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kProvider = "udpm://";
constexpr int kDefaultPort = 7667;  ///< LCM's
constexpr const char* kDescriptors = "/proc/self/fd";

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

std::string_view as_lcm_has(std::string_view url) {
  if (!url.empty()) return url;
  const char* const from_environment = std::getenv("LCM_DEFAULT_URL");
  return from_environment != nullptr ? from_environment : kProvider;
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

std::set<std::pair<int, ino_t>> sockets_bound_to(int port, std::error_code& failed) {
  std::set<std::pair<int, ino_t>> sockets;
  for (const fs::directory_entry& entry : fs::directory_iterator(kDescriptors, failed)) {
    const int descriptor = std::atoi(entry.path().filename().c_str());
    struct stat what {};
    if (is_bound_to(descriptor, port) && ::fstat(descriptor, &what) == 0) {
      sockets.emplace(descriptor, what.st_ino);
    }
  }
  return sockets;
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

LocalTraffic::LocalTraffic(std::string_view url) : port_(port_of_local_network(as_lcm_has(url))) {
  if (!port_) return;
  std::error_code unseen;  // then `guard` says so
  others_ = sockets_bound_to(*port_, unseen);
}

std::string LocalTraffic::guard() const {
  if (!port_) return {};
  std::error_code failed;
  int guarded = 0;
  for (const auto& socket : sockets_bound_to(*port_, failed)) {
    if (others_.contains(socket)) continue;
    if (!attach_filter(socket.first)) return std::generic_category().message(errno);
    ++guarded;
  }
  if (failed) return std::string(kDescriptors) + ": " + failed.message();
  return guarded > 0 ? "" : "no new socket is bound to UDP port " + std::to_string(*port_);
}

}  // namespace camway::wire
