// SPDX-License-Identifier: MIT
#include "daemon/messages/scene_names.h"

#include <algorithm>

namespace camway::messages {

bool is_scene_name(std::string_view name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  return !name.empty() && name.size() <= wire::kMaxSceneNameBytes &&
         std::all_of(name.begin(), name.end(), allowed);
}

}  // namespace camway::messages
