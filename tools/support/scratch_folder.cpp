// SPDX-License-Identifier: MIT
#include "tools/support/scratch_folder.h"

#include <cstdlib>
#include <string>
#include <system_error>

namespace camway::tools {

base::Result<ScratchFolder> ScratchFolder::make(std::string_view purpose) {
  std::error_code error;
  const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
  std::string name = (parent / ("camway-" + std::string(purpose) + "-XXXXXX")).string();
  if (error || mkdtemp(name.data()) == nullptr) return base::Failure{name + ": cannot be made"};
  return ScratchFolder(name);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

}  // namespace camway::tools
