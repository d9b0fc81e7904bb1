// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "tools/json/json_request.h"

namespace camway::tools {

/// Reads a request (`read_as`), and the mesh of its body where that is a file (`BodyFile`), as
/// scene files are read: in a confined process. Fails with a sentence that names the file and the
/// member.
base::Result<RequestFile> read_request(const std::string& file);

/// Reads a request as `read_request` does, from the text of `file`.
base::Result<RequestFile> read_request_text(const std::string& text, const std::string& file);

}  // namespace camway::tools
