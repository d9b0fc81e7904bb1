// SPDX-License-Identifier: MIT
#include "daemon/scene/import/child/collada_text.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "daemon/scene/import/readers/tokens.h"

namespace camway::scene {
namespace {

bool begins_number(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.'; }

}  // namespace

std::string without_blanks_before_numbers(std::string document) {
  std::size_t to = 0;
  for (std::size_t from = 0; from < document.size(); ++from) {
    document[to++] = document[from];
    if (document[from] != '>') continue;
    std::size_t after = from + 1;
    while (after < document.size() && mesh_readers::is_blank(document[after])) ++after;
    if (after < document.size() && begins_number(document[after])) from = after - 1;
  }
  document.resize(to);
  return document;
}

bool animates_single_axes(std::string_view document) {
  for (std::size_t at = document.find("<channel"); at != std::string_view::npos;
       at = document.find("<channel", at + 1)) {
    const std::string_view tag = document.substr(at, document.find('>', at) - at);
    const std::size_t target = tag.find("target=");
    const std::size_t member = tag.find('/', std::min(target, tag.size()));
    if (member != std::string_view::npos &&
        tag.find_first_of(".(", member) != std::string_view::npos) {
      return true;
    }
  }
  return false;
}

}  // namespace camway::scene
