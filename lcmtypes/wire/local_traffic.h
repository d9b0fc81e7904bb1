// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace lcm {
class LCM;
}  // namespace lcm

namespace camway::wire {

/// Returns the UDP port of an LCM URL whose messages stay on this host: provider `udpm` with ttl 0,
/// which is LCM's default. Returns nothing for any other URL.
std::optional<int> port_of_local_network(std::string_view url);

/// An LCM instance that can send and receive, or none.
struct OpenedLcm {
  std::unique_ptr<lcm::LCM> lcm;  ///< null if LCM cannot use the network
  /// Reason why other hosts are heard though the URL's ttl is 0. Empty if they are not heard, or if
  /// the ttl is not 0.
  std::string unguarded;
};

/// Opens LCM at `url`. An empty URL stands for LCM_DEFAULT_URL of the environment, or else LCM's
/// own default. With ttl 0, LCM's socket gets a filter that passes messages of this host only: a
/// ttl of 0 keeps sent messages on this host, but LCM joins the multicast group on the interface of
/// the route and would receive messages of other hosts there. Thread-safe.
OpenedLcm open_lcm(const std::string& url);

/// Finds LCM's receiving socket, which LCM's interface does not expose, and attaches a filter to
/// it.
///
/// Other threads may open and close descriptors at the same time, and the filter must never reach
/// one of their sockets. The order of steps ensures that:
///
/// 1. Before LCM is made, the cookies of all sockets bound to the port are recorded. The kernel
///    gives each socket a unique cookie, so the cookie of LCM's socket is not among them.
/// 2. All descriptors are scanned after LCM has made its socket and before it closes it. That
///    socket is open throughout the scan, so the scan finds it: bound to the port, with a cookie
///    that was not recorded.
/// 3. If the scan finds exactly one such descriptor, it is LCM's. Only LCM closes it, so it is
///    still LCM's when the filter is attached. If the scan finds several, it changes nothing.
///
/// The scan only reads. A descriptor that another thread closes or reuses meanwhile can only add to
/// the descriptors that it finds. [Source: socket(7), SO_COOKIE and SO_ATTACH_FILTER; proc(5),
/// /proc/self/fd]
class LocalTraffic {
 public:
  /// Runs step 1. `url` is the URL that LCM will be opened with.
  explicit LocalTraffic(std::string_view url);

  struct Guarded {
    std::string fault;       ///< reason why other hosts are heard; empty on success
    bool try_again = false;  ///< another thread opened such a socket; a new LCM may succeed
  };
  /// Runs steps 2 and 3. Afterwards LCM's socket receives messages of this host only; messages that
  /// already wait in it are still delivered. Does nothing if the URL's ttl is not 0. Requires an
  /// LCM that was made after this object, has set up its receiver, and is not destroyed meanwhile.
  [[nodiscard]] Guarded guard() const;

 private:
  std::optional<int> port_;
  std::set<std::uint64_t> others_;  ///< cookies of the sockets that were bound to the port before
};

}  // namespace camway::wire
