// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/base/digest.h"
#include "daemon/scene/cache/prepared_scene.h"

namespace camway::scene {

/// Identifies a prepared scene: a digest of everything that determines it. A value type.
struct SceneKey {
  base::Digest::Bytes bytes{};

  /// Returns the digest as 32 hexadecimal digits.
  [[nodiscard]] std::string text() const { return base::Digest::text_of(bytes); }
  bool operator==(const SceneKey&) const = default;
};

/// Returns 32 hexadecimal digits that identify the code that prepares scenes: a digest of its
/// sources, its compiler and its flags.
std::string_view scene_build();

/// Returns the key of the scene that `file` holds now. It covers the bytes of the file, the format
/// that its extension names, `scene_build`, and the options. It does not cover options that do not
/// change the result, such as numbers of threads. Returns nothing for a file that cannot be read,
/// or whose format has no reader of our own: other readers may open further files. Thread-safe.
std::optional<SceneKey> scene_key(const std::filesystem::path& file,
                                  const PreparationOptions& options);

}  // namespace camway::scene
