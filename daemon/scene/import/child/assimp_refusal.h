// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace camway::scene {

/// Returns why assimp 5.2 cannot read a file, in words that say what to do, where its own do not:
/// compressed glTF, and IFC of a later schema. `begin` is the first part of the file. `error` is
/// what assimp says, and is returned where nothing better is known.
std::string refusal_of_assimp(std::string_view extension, std::string_view begin,
                              const std::string& error);

}  // namespace camway::scene
