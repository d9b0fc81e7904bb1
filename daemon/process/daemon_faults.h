// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/process/options.h"

/// What is wrong with options of which each value is right by itself: a text for each fault, which
/// begins with where the value was said.
namespace camway::service {

/// Values that contradict each other.
std::vector<std::string> contradictions(const DaemonOptions& options);

/// The key file and the address for metrics, of which this machine must have what the options say.
/// Looks at them and changes nothing.
std::vector<std::string> missing_things(const DaemonOptions& options);

}  // namespace camway::service
