// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace camway::scene {

/// Returns a COLLADA document without the blanks between a tag and a number that follows it:
/// `<color> 0.3 0.3 0.3 1</color>` is valid, many programs write it, and assimp 5.2 refuses the
/// whole file for it. Nothing else changes.
std::string without_blanks_before_numbers(std::string document);

}  // namespace camway::scene
