// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <camway/status_t.hpp>

namespace camway::service {

/// A status as Prometheus reads it (text exposition format 0.0.4), every metric with its help and
/// type. Of histograms every fourth bucket is said, which is one for each doubling.
std::string metrics_text(const status_t& status);

}  // namespace camway::service
