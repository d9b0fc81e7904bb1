// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace camway::wire {

/// The UDP port of an LCM URL that says that messages stay on this host: provider `udpm` with a
/// ttl of 0, which is LCM's default. Nothing of any other URL.
std::optional<int> port_of_local_network(std::string_view url);

/// Keeps what other hosts say from the sockets that LCM hears with. A ttl of 0 keeps what is sent
/// from leaving; but LCM joins the multicast group on the interface that has the route, and would
/// hear what is said there. LCM gives nobody its sockets, so they are known by being new: made
/// before LCM is, told to `guard` after LCM made them. For one thread; what another makes of LCM's
/// for the same port in between is guarded, too. [Source: socket(7), SO_ATTACH_FILTER]
class LocalTraffic {
 public:
  /// `url`: as LCM is given it; an empty one is the environment's LCM_DEFAULT_URL, else LCM's own.
  explicit LocalTraffic(std::string_view url);

  /// From now on the new sockets that are bound to the URL's port hear this host only; what waits
  /// in them is heard. Does nothing where the URL lets other hosts speak. Returns why it cannot be
  /// done; empty on success.
  [[nodiscard]] std::string guard() const;

 private:
  /// A descriptor and what it stands for, as numbers of descriptors are used again.
  using Socket = std::pair<int, ino_t>;

  std::optional<int> port_;
  std::set<Socket> others_;  ///< that were bound to it before
};

}  // namespace camway::wire
