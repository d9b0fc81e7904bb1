// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include "daemon/base/result.h"

namespace camway::scene {

/// A file that a scene file includes.
struct IncludedFile {
  std::string name;  ///< for messages, and to find the files that it includes itself
  std::string text;
};

/// Reads the file that `name` means in the file `from`, which is empty for the scene file. Fails
/// with the reason.
using OpenInclude =
    std::function<base::Result<IncludedFile>(const std::string& from, const std::string& name)>;

}  // namespace camway::scene
