// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

#include "daemon/scene/import/record/import_options.h"

namespace camway::scene {

/// The words for options of reading a scene file in command lines, configurations and requests.
constexpr std::array<std::string_view, 3> names_of(UpAxis) {
  return {"as-in-file", "z-to-y", "y-to-z"};
}
constexpr std::array<std::string_view, 2> names_of(UnknownSpace) { return {"free", "occupied"}; }

}  // namespace camway::scene
