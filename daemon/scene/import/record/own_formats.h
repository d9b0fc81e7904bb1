// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

namespace camway::scene {

/// Extensions of the formats that have a reader of our own, in lower case. Such a reader sees the
/// bytes of one file and nothing else, so these determine the mesh.
inline constexpr std::array<std::string_view, 4> kOwnFormats = {".obj", ".off", ".ply", ".stl"};

}  // namespace camway::scene
