// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "tests/tools/camway/replay/log_builder.h"

namespace camway::tools {

/// How a run of the built `camway` ended.
struct CliRun {
  int exit_code = -1;  ///< -1 if it did not end by itself
  std::string out;
  std::string err;
};

/// Runs `camway` with `arguments` as they are, no shell between; standard input is empty unless
/// `input_file` names a file.
CliRun run_camway(const std::vector<std::string>& arguments, const std::string& input_file = {});

/// A request as a person would write it: keyframes are objects in JSON.
std::string request_json(const std::vector<std::string>& keyframes,
                         const std::string& scene = "wall.obj");
/// A keyframe that looks along -Z from there.
std::string keyframe_json(double x, double y, double z);

}  // namespace camway::tools
