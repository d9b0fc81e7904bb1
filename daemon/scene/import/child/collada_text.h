// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace camway::scene {

/// Returns a COLLADA document without the blanks between a tag and a number that follows it:
/// `<color> 0.3 0.3 0.3 1</color>` is valid, many programs write it, and assimp 5.2 refuses the
/// whole file for it. Nothing else changes.
std::string without_blanks_before_numbers(std::string document);

/// Whether an animation of a COLLADA document has a channel for an axis or an angle, as
/// `location.X`, in place of whole matrices. assimp 5.2 loses the other axes.
bool animates_single_axes(std::string_view document);

}  // namespace camway::scene
