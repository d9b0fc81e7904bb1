// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "daemon/service/transport/transport.h"

namespace camway::service {

/// An LCM transport, or why there is none.
struct OpenedTransport {
  std::unique_ptr<Transport> transport;
  std::string error;  ///< says what to do about it; empty exactly when `transport` is set
};

/// Opens LCM at `url`, e.g. "udpm://239.255.76.67:7667?ttl=0". Every provider of LCM works that can
/// send and receive. With a ttl of 0 it hears only this host; where that cannot be had, `warn` is
/// told why, once.
OpenedTransport open_lcm_transport(const std::string& url,
                                   const std::function<void(const std::string&)>& warn = {});

/// What to try when LCM cannot use the network.
std::string multicast_hint();

}  // namespace camway::service
