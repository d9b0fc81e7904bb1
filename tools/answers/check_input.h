// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/base/deadline.h"
#include "daemon/base/result.h"
#include "tools/answers/check_report.h"
#include "tools/json/json_request.h"
#include "tools/json/json_response.h"

namespace camway::tools {

/// Names of the two documents of a check, which begin errors about them.
struct CheckNames {
  std::string request;
  std::string response;
};

/// Returns what a path is checked against, without the scene; or the fault of request or path,
/// which names its document. Requires a request whose body is no file.
base::Result<CheckInput> check_input(const RequestFile& request, const PathFile& response,
                                     const CheckNames& names);

/// Searches the path. Requires `input.snapshot`.
PathSearch search_path(const CheckInput& input, const base::Deadline& deadline);

}  // namespace camway::tools
