// SPDX-License-Identifier: MIT
#pragma once

#include <assimp/DefaultIOSystem.h>

namespace camway::scene {

/// Opens files for assimp. A name that is not there is tried as a part of a URI, in which a blank
/// is "%20": glTF asks for that, and assimp does not decode it.
class EncodedNames : public Assimp::DefaultIOSystem {
 public:
  bool Exists(const char* file) const override;
  Assimp::IOStream* Open(const char* file, const char* mode) override;
};

}  // namespace camway::scene
