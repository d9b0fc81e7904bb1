// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

namespace camway::scene {

/// The axis that points up in a scene as it was read, the turn of `UpAxis` included.
enum class VerticalAxis { kY, kZ };

/// The words in files and command lines.
constexpr std::array<std::string_view, 2> names_of(VerticalAxis) { return {"y", "z"}; }

}  // namespace camway::scene
