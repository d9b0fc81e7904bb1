// SPDX-License-Identifier: MIT
#include <arpa/inet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <sstream>
#include <string>

#include <camway/status_t.hpp>
#include <lcm/lcm-cpp.hpp>

#include "daemon/process/settings/config_file.h"
#include "daemon/version/version.h"
#include "lcmtypes/wire/channels.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/envelope.h"
#include "lcmtypes/wire/local_traffic.h"
#include "tools/camway/doctor/doctor.h"

namespace camway::tools {
namespace {

using Clock = std::chrono::steady_clock;

std::optional<std::int64_t> number_in_file(const char* file) {
  std::ifstream stream(file);
  std::int64_t value = 0;
  return stream >> value ? std::optional(value) : std::nullopt;
}

/// Returns the device of the longest prefix that contains `group`, from the kernel's main routing
/// table. A line has device, destination, gateway, flags, three counts, mask, ...; addresses are
/// hexadecimal, in the byte order of `in_addr`.
std::string device_towards(const in_addr& group) {
  std::ifstream stream("/proc/net/route");
  std::string best;
  int longest = -1;
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string device;
    std::string counts;
    std::uint32_t destination = 0;
    std::uint32_t gateway = 0;
    std::uint32_t flags = 0;
    std::uint32_t mask = 0;
    words >> device >> std::hex >> destination >> gateway >> flags;
    for (int i = 0; i < 3; ++i) words >> counts;
    if (!(words >> mask) || (group.s_addr & mask) != destination) continue;
    if (std::popcount(mask) <= longest) continue;
    longest = std::popcount(mask);
    best = device;
  }
  return best;
}

bool does_multicast(const std::string& device, int fd) {
  ifreq request{};
  if (device.size() >= sizeof request.ifr_name) return true;
  device.copy(request.ifr_name, device.size());
  if (::ioctl(fd, SIOCGIFFLAGS, &request) != 0) return true;  // not ours to judge
  // The loopback carries multicast without the flag, once there is a route (measured).
  return (request.ifr_flags & (IFF_MULTICAST | IFF_LOOPBACK)) != 0;
}

/// Asks the kernel whether it can send to the group, and by which device. Sends nothing.
std::optional<MulticastRoute> route_to(const LcmNetwork& network) {
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(network.port);
  if (::inet_pton(AF_INET, network.group.c_str(), &group.sin_addr) != 1) return std::nullopt;
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return std::nullopt;
  std::optional<MulticastRoute> route;
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&group), sizeof group) == 0) {
    const std::string device = device_towards(group.sin_addr);
    route =
        MulticastRoute{device.empty() ? "a table of its own" : device, does_multicast(device, fd)};
  }
  ::close(fd);
  return route;
}

/// Returns "RcvbufErrors" of /proc/net/snmp: a line of names, then one of numbers, each beginning
/// with "Udp:".
std::int64_t dropped_datagrams() {
  std::ifstream stream("/proc/net/snmp");
  std::string names;
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("Udp:", 0) != 0) continue;
    if (names.empty()) {
      names = line;
      continue;
    }
    std::istringstream keys(names);
    std::istringstream values(line);
    std::string key;
    std::string value;
    while (keys >> key && values >> value) {
      if (key == "RcvbufErrors") return std::stoll(value);
    }
  }
  return 0;
}

/// Listens for the first status that can be read, and on until the same daemon is heard again.
class StatusListener {
 public:
  /// `authentication` may be null.
  explicit StatusListener(const std::shared_ptr<const Authentication>& authentication)
      : session_(authentication ? authentication->begin() : nullptr) {}

  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    const std::span<const std::uint8_t> bytes(static_cast<const std::uint8_t*>(buffer->data),
                                              buffer->data_size);
    // The status counts as heard whoever signed it; its signature is judged separately.
    const auto message = wire::payload_unchecked(bytes);
    if (!message) return;
    const wire::Decoded<status_t> decoded = wire::decode<status_t>(*message);
    if (!decoded.message) return;
    note(*decoded.message, signature_of(channel, bytes, decoded.message->signed_only != 0));
  }
  [[nodiscard]] const std::optional<DaemonFact>& fact() const { return fact_; }
  [[nodiscard]] bool is_done() const { return is_done_; }

 private:
  [[nodiscard]] Signature signature_of(const std::string& channel,
                                       std::span<const std::uint8_t> bytes,
                                       bool signed_only) const {
    if (session_) {
      return session_->open(channel, bytes.data(), bytes.size()) ? Signature::kOurs
                                                                 : Signature::kDistrusted;
    }
    if (signed_only) return Signature::kNeeded;
    return wire::is_envelope(bytes) ? Signature::kUnchecked : Signature::kNone;
  }

  void note(const status_t& status, Signature signature) {
    // Daemons are distinguished by the time of their start, which follows from each status.
    constexpr double kSameStart_s = 0.05;
    const double utime_s = static_cast<double>(status.utime) * 1e-6;
    const double started_s = utime_s - status.uptime_s;
    if (!fact_) {
      const std::chrono::duration<double> now = std::chrono::system_clock::now().time_since_epoch();
      fact_ = DaemonFact{status.version, utime_s - now.count()};
      fact_->signature = signature;
      started_s_ = started_s;
    } else if (std::abs(started_s - started_s_) <= kSameStart_s) {
      is_done_ = true;
    } else {
      fact_->is_alone = false;
    }
  }

  std::unique_ptr<Authentication::Session> session_;  ///< null: we have no keys
  std::optional<DaemonFact> fact_;
  double started_s_ = 0.0;
  bool is_done_ = false;
};

/// Opens LCM and listens for a status. Writes both outcomes into `facts`.
void listen_for_daemon(const DoctorOptions& options, HostFacts& facts) {
  const wire::OpenedLcm opened = wire::open_lcm(options.url);
  StatusListener listener(options.authentication);
  const wire::Channels channels{options.prefix};
  if (!opened.lcm ||
      opened.lcm->subscribe(channels.status(), &StatusListener::on_message, &listener) == nullptr) {
    facts.lcm_error = "LCM cannot be opened at '" + options.url + "'";
    return;
  }
  facts.unguarded = opened.unguarded;
  const Clock::time_point end =
      Clock::now() +
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.timeout_s));
  while (!listener.is_done() && Clock::now() < end) {
    constexpr int kLook_ms = 50;
    if (opened.lcm->handleTimeout(kLook_ms) < 0) {
      facts.lcm_error = "LCM failed at '" + options.url + "'";
      return;
    }
  }
  facts.daemon = listener.fact();
}

void look_at_config(const std::string& file, HostFacts& facts) {
  facts.config_file = file;
  if (file.empty()) return;
  process::DaemonOptions options = process::default_options();
  std::error_code unreadable;
  facts.config_is_readable = std::filesystem::is_regular_file(file, unreadable) &&
                             std::filesystem::file_size(file, unreadable) > 0 &&
                             ::access(file.c_str(), R_OK) == 0;
  facts.config_faults = process::read_config_file(file, options);
  if (!facts.config_faults.empty()) return;
  for (const process::SceneArgument& scene : options.scenes) {
    std::error_code ignored;
    facts.scene_files.push_back({scene.name, scene.file.string(),
                                 std::filesystem::exists(scene.file, ignored),
                                 ::access(scene.file.c_str(), R_OK) == 0});
  }
}

}  // namespace

HostFacts gather_facts(const DoctorOptions& options) {
  HostFacts facts;
  facts.network = service::parse_lcm_url(options.url);
  facts.other_hosts = options.other_hosts;
  facts.own_version = service::kVersion;
  if (facts.network.multicast) facts.route = route_to(facts.network);
  facts.receive_buffer_bytes = number_in_file("/proc/sys/net/core/rmem_default");
  facts.largest_receive_buffer_bytes = number_in_file("/proc/sys/net/core/rmem_max");
  facts.dropped_datagrams = dropped_datagrams();
  listen_for_daemon(options, facts);
  look_at_config(options.config_file, facts);
  return facts;
}

}  // namespace camway::tools
