// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <camway/status_t.hpp>

namespace camway::process {

/// Returns a status in the text exposition format 0.0.4 of Prometheus, every metric with its help
/// and type. Histograms have every fourth bucket, which is one for each doubling.
std::string metrics_text(const status_t& status);

}  // namespace camway::process
