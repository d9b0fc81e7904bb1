// SPDX-License-Identifier: MIT
#include "daemon/scene/import/child/encoded_names.h"

#include "daemon/base/percent.h"

namespace camway::scene {

bool EncodedNames::Exists(const char* file) const {
  return DefaultIOSystem::Exists(file) ||
         DefaultIOSystem::Exists(base::percent_decoded(file).c_str());
}

Assimp::IOStream* EncodedNames::Open(const char* file, const char* mode) {
  Assimp::IOStream* const stream = DefaultIOSystem::Open(file, mode);
  return stream != nullptr ? stream
                           : DefaultIOSystem::Open(base::percent_decoded(file).c_str(), mode);
}

}  // namespace camway::scene
