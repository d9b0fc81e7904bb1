// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "tools/lcm_types/type_file.h"

namespace camway::tools {

/// The structs that the messages of a log may be of.
struct LogTypes {
  LcmTypes structs;
  /// A sentence for each struct that another has a member of, and no file defines: the names of
  /// files that were tried.
  std::vector<std::string> missing;
};

/// Reads the structs of all `files`, and those that these name of files beside them, as
/// `robot_pose_t.lcm` or `pose_t.lcm` for `robot.pose_t`. Fails for a file that cannot be read or
/// has a fault.
base::Result<LogTypes> read_log_types(const std::vector<std::string>& files);

}  // namespace camway::tools
