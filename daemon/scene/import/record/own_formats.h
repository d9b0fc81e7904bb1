// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

namespace camway::scene {

/// Extensions of the formats that have a reader of our own, in lower case. `mesh_reader.cpp` has
/// the readers in this order. Such a reader sees the bytes of one file and nothing else, so these
/// bytes determine the mesh.
inline constexpr std::array<std::string_view, 4> kOwnFormats = {".obj", ".off", ".ply", ".stl"};

}  // namespace camway::scene
