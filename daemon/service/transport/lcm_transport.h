// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "daemon/service/transport/transport.h"

namespace camway::service {

/// Opens LCM at `url`, e.g. "udpm://239.255.76.67:7667?ttl=0". Works with every LCM provider that
/// can send and receive. With a ttl of 0, the transport receives from this host only. If that is
/// not possible, calls `warn` once with the reason. Returns a transport that is not null, or an
/// error that says how to mend it.
base::Result<std::unique_ptr<Transport>> open_lcm_transport(
    const std::string& url, const std::function<void(const std::string&)>& warn = {});

/// Returns advice for machines on which LCM cannot use the network.
std::string multicast_hint();

}  // namespace camway::service
