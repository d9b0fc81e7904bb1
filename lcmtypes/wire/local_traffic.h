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

/// The UDP port of an LCM URL that says that messages stay on this host: provider `udpm` with a
/// ttl of 0, which is LCM's default. Nothing of any other URL.
std::optional<int> port_of_local_network(std::string_view url);

/// An LCM that can send and receive, or nothing.
struct OpenedLcm {
  std::unique_ptr<lcm::LCM> lcm;  ///< null if LCM cannot use the network
  /// Why other hosts are heard though the URL's ttl is 0; empty if they are not, or may be.
  std::string unguarded;
};

/// Opens LCM at `url`; an empty one is the environment's LCM_DEFAULT_URL, else LCM's own. With a
/// ttl of 0 it hears only this host: a ttl of 0 keeps what is sent from leaving, but LCM joins the
/// multicast group on the interface that has the route, and would hear what other hosts say there.
/// So its socket gets a filter. From any thread.
OpenedLcm open_lcm(const std::string& url);

/// Finds the socket that LCM hears with, which LCM tells nobody, and gives it the filter.
///
/// Other threads of the program open and close descriptors meanwhile, and a filter must never reach
/// a socket of theirs. The order of steps sees to that:
///
/// 1. Before LCM is made, the cookies of the sockets that are bound to the port are noted. The
///    kernel gives each socket another cookie and none twice. LCM's is not among them.
/// 2. After LCM has made its socket and before it closes it, all descriptors are looked at. LCM's
/// is
///    open all the time, so the look finds it: bound to the port, with a cookie that was not noted.
/// 3. If the look finds exactly one such descriptor, then that one is LCM's, and nobody else closes
///    it, so that it is still LCM's when the filter is set. If it finds several, nothing is
///    changed.
///
/// Reading a descriptor that another thread closes or uses again at that time changes nothing, and
/// what is read of it can only add to the descriptors that are found. [Source: socket(7),
/// SO_COOKIE and SO_ATTACH_FILTER; proc(5), /proc/self/fd]
class LocalTraffic {
 public:
  /// Step 1, for the URL as LCM is given it.
  explicit LocalTraffic(std::string_view url);

  struct Guarded {
    std::string fault;       ///< why other hosts are heard; empty on success
    bool try_again = false;  ///< another LCM may do: somebody else opened such a socket meanwhile
  };
  /// Steps 2 and 3. From then on LCM's socket hears this host only; what waits in it is heard. Does
  /// nothing where the URL lets other hosts speak. Precondition: an LCM was made after this was, it
  /// has set up its receiving half, and nobody destroys it meanwhile.
  [[nodiscard]] Guarded guard() const;

 private:
  std::optional<int> port_;
  std::set<std::uint64_t> others_;  ///< cookies of what was bound to it before
};

}  // namespace camway::wire
