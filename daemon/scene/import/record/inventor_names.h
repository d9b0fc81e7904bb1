// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace camway::scene {

/// How names of Open Inventor and VRML files end, in lower case.
inline constexpr std::array<std::string_view, 8> kInventorEndings = {
    ".iv", ".wrl", ".vrml", ".wrz", ".iv.gz", ".wrl.gz", ".ivz", ".iv.asc"};

/// Whether a file of this name is read as Open Inventor or VRML, in any case of letters.
inline bool is_inventor_name(std::string_view name) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::ranges::any_of(kInventorEndings, [&](std::string_view ending) {
    return name.size() > ending.size() &&
           std::ranges::equal(name.substr(name.size() - ending.size()), ending, {}, lower);
  });
}

}  // namespace camway::scene
