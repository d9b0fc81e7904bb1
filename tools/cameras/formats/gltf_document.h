// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/base/result.h"
#include "tools/cameras/formats/camera_format.h"

namespace camway::tools {

/// A glTF 2.0 file, `.gltf` or `.glb`, with its buffers. Accepts any bytes: nothing of the document
/// is trusted.
class GltfDocument {
 public:
  static base::Result<GltfDocument> parse(const CameraFile& file);

  [[nodiscard]] const nlohmann::json& root() const { return root_; }

  /// The element of a top-level array; an empty object if there is none.
  [[nodiscard]] const nlohmann::json& element(const char* array, std::size_t index) const;

  /// Reads an accessor of `components` numbers an element, normalised integers as fractions. Fails
  /// if it is of another kind, sparse or compressed, or reaches beyond its buffer.
  [[nodiscard]] base::Result<std::vector<double>> values(std::size_t accessor,
                                                         std::size_t components) const;

 private:
  nlohmann::json root_;
  std::vector<std::string> buffers_;
};

/// The member as an index; nothing if it is none.
std::optional<std::size_t> gltf_index(const nlohmann::json& object, const char* key);
/// The member as a number; nothing if it is none.
std::optional<double> gltf_number(const nlohmann::json& object, const char* key);

}  // namespace camway::tools
