// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/local_traffic.h"

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
#include <mutex>
#include <system_error>
#include <vector>

#include <lcm/lcm-cpp.hpp>

namespace camway::wire {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kProvider = "udpm://";
constexpr int kDefaultPort = 7667;  ///< default of LCM
constexpr const char* kDescriptors = "/proc/self/fd";

/// Returns the value of the option `name` of a URL; empty if it is not there.
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

struct Socket {
  int descriptor = -1;
  std::uint64_t cookie = 0;  ///< unique among all sockets since the machine started
};

/// Returns every descriptor of a socket that is bound to `port` throughout the scan, and perhaps
/// some that other threads open, close or reuse meanwhile. Only reads.
std::vector<Socket> sockets_bound_to(int port, std::error_code& failed) {
  std::vector<Socket> sockets;
  for (const fs::directory_entry& entry : fs::directory_iterator(kDescriptors, failed)) {
    Socket socket{std::atoi(entry.path().filename().c_str())};
    socklen_t size = sizeof socket.cookie;
    if (is_bound_to(socket.descriptor, port) &&
        ::getsockopt(socket.descriptor, SOL_SOCKET, SO_COOKIE, &socket.cookie, &size) == 0) {
      sockets.push_back(socket);
    }
  }
  return sockets;
}

/// Attaches a filter that passes packets that the kernel looped back while sending, and packets of
/// the loopback device. Packets of other hosts cannot have these marks.
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
  // The same as in LCM: a text that is no number is 0, and a large number is truncated to 8 bits.
  const long ttl = std::strtol(option(options, "ttl").c_str(), nullptr, 0);
  if (static_cast<std::uint8_t>(ttl) != 0) return std::nullopt;
  const std::size_t colon = host.find(':');
  if (colon == std::string_view::npos) return kDefaultPort;
  return std::atoi(std::string(host.substr(colon + 1)).c_str());
}

LocalTraffic::LocalTraffic(std::string_view url) : port_(port_of_local_network(as_lcm_has(url))) {
  if (!port_) return;
  std::error_code unseen;  // after a failure `guard` finds too many, or fails as well
  for (const Socket& socket : sockets_bound_to(*port_, unseen)) others_.insert(socket.cookie);
}

LocalTraffic::Guarded LocalTraffic::guard() const {
  if (!port_) return {};
  std::error_code failed;
  std::vector<Socket> found = sockets_bound_to(*port_, failed);
  // An incomplete scan may have missed LCM's socket.
  if (failed) return {std::string(kDescriptors) + ": " + failed.message()};
  std::erase_if(found, [this](const Socket& socket) { return others_.contains(socket.cookie); });
  const std::string port = "UDP port " + std::to_string(*port_);
  if (found.empty()) return {"no new socket is bound to " + port};
  if (found.size() > 1) {
    return {"another socket was bound to " + port + " at the same time", /*try_again=*/true};
  }
  if (!attach_filter(found.front().descriptor)) return {std::generic_category().message(errno)};
  return {};
}

OpenedLcm open_lcm(const std::string& url) {
  // Descriptors belong to the process, so one lock for the process keeps Camway's LCMs from opening
  // theirs at the same time.
  static std::mutex one_at_a_time;
  // Other LCMs of the program may open such sockets, which is rare.
  constexpr int kMostTries = 5;
  std::unique_lock lock(one_at_a_time, std::defer_lock);
  if (port_of_local_network(as_lcm_has(url))) lock.lock();
  OpenedLcm opened;
  for (int i = 0; i < kMostTries; ++i) {
    opened = {};
    const LocalTraffic local(url);
    opened.lcm = std::make_unique<lcm::LCM>(url);
    // getFileno makes LCM set up and test its receiver, which is when it detects failures.
    if (!opened.lcm->good() || opened.lcm->getFileno() < 0) return {};
    const LocalTraffic::Guarded guarded = local.guard();
    opened.unguarded = guarded.fault;
    if (!guarded.try_again) break;
  }
  return opened;
}

}  // namespace camway::wire
