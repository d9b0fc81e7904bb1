// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "tools/camway/replay/compare/comparison.h"
#include "tools/camway/replay/replay_run.h"

namespace camway::tools {

/// A result as it is after it was written to a response file and read from it. Answers of two
/// builds are compared in this form, because the other build writes such files.
base::Result<RecordedAnswer> answer_through_file(const ReplayedRequest& replayed);

/// Reads the responses that `camway replay --responses` wrote to `folder`: sets the answer of each
/// request to the one there, or to none. Returns an error that names the file; empty on success.
std::string take_responses(const std::string& folder, std::vector<RecordedRequest>& requests);

/// Runs a program and waits for its end, with its output in `output_file`. Returns its exit code,
/// or why it could not run or ended by a signal.
base::Result<int> run_program(const std::vector<std::string>& command,
                              const std::string& output_file);

}  // namespace camway::tools
