// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/process/settings/daemon_options.h"

/// Faults of options whose values are each valid by themselves. Each fault is a text that begins
/// with the place where the value was set.
namespace camway::process {

/// Returns the faults of values that contradict each other.
std::vector<std::string> contradictions(const DaemonOptions& options);

/// Returns the faults of the files that this process proves itself with in a fleet, as far as they
/// can be found without a server. Changes nothing.
std::vector<std::string> unusable_fleet_files(const DaemonOptions& options);

/// Returns the faults of these files, of the key file, of the address for metrics and of the folder
/// of recordings if this machine lacks them. Changes nothing.
std::vector<std::string> missing_things(const DaemonOptions& options);

/// Returns why the folder of recordings can be neither written nor made; empty without a folder or
/// a fault. Changes nothing.
std::string fault_of_record_folder(const DaemonOptions& options);

}  // namespace camway::process
