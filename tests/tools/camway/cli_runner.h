// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "tests/tools/camway/replay/log_builder.h"

namespace camway::tools {

/// The result of a run of the built `camway`.
struct CliRun {
  int exit_code = -1;  ///< -1 if a signal ended it
  std::string out;
  std::string err;
};

/// Runs `camway` with these arguments, without a shell. Standard input is `input_file`, or empty.
CliRun run_camway(const std::vector<std::string>& arguments, const std::string& input_file = {});

/// Returns a request file as a person would write it; keyframes are JSON objects.
std::string request_json(const std::vector<std::string>& keyframes,
                         const std::string& scene = "wall.obj");
/// Returns a keyframe at this position that looks along -Z.
std::string keyframe_json(double x, double y, double z);

}  // namespace camway::tools
