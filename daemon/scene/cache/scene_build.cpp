// SPDX-License-Identifier: MIT
#include "daemon/scene/cache/scene_build.h"

#include "daemon/scene/cache/scene_key.h"

namespace camway::scene {

std::string_view scene_build() {
  static_assert(sizeof(kSceneBuild) == 32 + 1);
  return kSceneBuild;
}

}  // namespace camway::scene
