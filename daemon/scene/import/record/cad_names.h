// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace camway::scene {

/// How names of IGES files end, in lower case.
inline constexpr std::array<std::string_view, 2> kIgesEndings = {".iges", ".igs"};

/// How names of STEP files end, in lower case.
inline constexpr std::array<std::string_view, 2> kStepEndings = {".step", ".stp"};

/// Whether a name ends as one of `endings`, in any case of letters.
template <class Endings>
bool ends_as_one_of(std::string_view name, const Endings& endings) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::ranges::any_of(endings, [&](std::string_view ending) {
    return name.size() > ending.size() &&
           std::ranges::equal(name.substr(name.size() - ending.size()), ending, {}, lower);
  });
}

inline bool is_iges_name(std::string_view name) { return ends_as_one_of(name, kIgesEndings); }

/// Whether a file of this name is read as STEP or IGES.
inline bool is_cad_name(std::string_view name) {
  return is_iges_name(name) || ends_as_one_of(name, kStepEndings);
}

}  // namespace camway::scene
