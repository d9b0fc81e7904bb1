// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/scene/import/readers/included_file.h"

class SoSeparator;

namespace camway::scene::inventor {

/// Limits of inline files: a file can include itself, or another one any number of times.
inline constexpr std::size_t kMostInlineDepth = 16;
inline constexpr std::size_t kMostInlineFiles = 1000;

/// A file as Coin read it, with its inline files in place.
struct SceneGraph {
  SoSeparator* root = nullptr;  ///< kept until the process ends
  std::string format;           ///< "Open Inventor 2.1", "VRML 97, binary"
  bool is_vrml = false;
  bool has_units = false;  ///< a node Units, which Coin applies
  std::uint64_t inline_files = 0;
  std::uint64_t nodes = 0;
  std::uint64_t coarse_levels =
      0;  ///< children of levels of detail that are not the finest; removed
  std::vector<std::string> not_fetched;          ///< inline files that are no files here
  std::map<std::string, std::uint64_t> ignored;  ///< nodes that are no geometry and were not read
  std::vector<std::string> warnings;             ///< of Coin
};

/// The folder of a scene, for nodes that Coin reads by itself (File), and what opens a file in it.
struct SceneFolder {
  std::string folder;  ///< canonical
  OpenInclude open;
};

/// Reads bytes that are not compressed. Fails with Coin's text if Coin reports an error of reading,
/// or if an inline file cannot be read, is outside the folder or includes itself. Requires
/// `start_coin`.
base::Result<SceneGraph> read_scene_graph(std::string_view bytes, const SceneFolder& folder);

}  // namespace camway::scene::inventor
