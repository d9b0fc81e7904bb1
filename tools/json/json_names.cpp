// SPDX-License-Identifier: MIT
#include "tools/json/json_names.h"

namespace camway::tools {

planning::FieldSpelling json_spelling() {
  return [](std::string_view path) { return planning::spell(path, planning::Spelling::kFile); };
}

}  // namespace camway::tools
