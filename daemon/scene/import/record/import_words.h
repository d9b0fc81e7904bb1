// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "daemon/scene/import/record/import_options.h"

namespace camway::scene {

/// The words for options of reading a scene file in command lines, configurations and requests.
inline constexpr std::array<std::pair<std::string_view, UpAxis>, 3> kUpAxes{{
    {"as-in-file", UpAxis::kAsInFile},
    {"z-to-y", UpAxis::kZToY},
    {"y-to-z", UpAxis::kYToZ},
}};
inline constexpr std::array<std::pair<std::string_view, UnknownSpace>, 2> kUnknownSpaces{{
    {"free", UnknownSpace::kFree},
    {"occupied", UnknownSpace::kOccupied},
}};

}  // namespace camway::scene
