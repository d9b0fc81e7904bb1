// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace camway::service {

/// The UDP port of an LCM URL that says that messages stay on this host: provider `udpm` with a
/// ttl of 0, which is LCM's default. Nothing of any other URL.
std::optional<int> port_of_local_network(std::string_view url);

/// From now on the UDP sockets of this process that are bound to `port` hear this host only. A ttl
/// of 0 keeps what is sent from leaving; but LCM joins the multicast group on the interface that
/// has the route, and would hear what other hosts say there. Returns why it cannot be done; empty
/// on success. [Source: socket(7), SO_ATTACH_FILTER]
std::string hear_this_host_only(int port);

}  // namespace camway::service
