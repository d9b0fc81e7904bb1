// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace camway::scene {

/// Returns why files with this extension are not read, and what to do instead: "USD is not
/// supported: export glTF". Empty for an extension of which nothing is known. Without this, assimp
/// tries all of its readers, and the error is that of the last one.
std::string_view why_unsupported(std::string_view extension);

}  // namespace camway::scene
