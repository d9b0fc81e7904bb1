// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "tools/cameras/formats/camera_format.h"

namespace camway::tools {

/// Reads a file, and lets its reader open others in its folder or below it. The error names it.
base::Result<CameraFile> camera_file(const std::string& name);

}  // namespace camway::tools
