// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "daemon/base/result.h"
#include "daemon/scene/cache/prepared_scene.h"
#include "daemon/scene/cache/scene_key.h"

/// Files with a prepared scene each; `cache_layout.h` has their layout.
namespace camway::scene {

/// Returns the size of the file that `write_prepared` makes.
std::uint64_t prepared_bytes(const std::string& scene_file, const PreparedScene& prepared);

/// Writes the scene into an empty file that is open for writing. `scene_file` names the file that
/// it was read from, for lists. Returns false if not all could be written.
bool write_prepared(int fd, const SceneKey& key, const std::string& scene_file,
                    const PreparedScene& prepared);

/// Reads a file that `write_prepared` made with this key in this build. The options are those that
/// the key was made with. Returns the fault of any other file: believes no size before the file has
/// so many bytes, compares the digest of each section, and checks everything that the scene is
/// used with, so that the mesh is one that an import could have made, and no query leaves the
/// arrays of tree and field. That the boxes of the tree and the bounds of the field are right is
/// covered by the digests alone.
///
/// Tree and field refer to the file, which is mapped into memory (`FileBytes`). Requires that
/// nobody writes into the file any more; it may be removed.
base::Result<PreparedScene> read_prepared(int fd, const SceneKey& key,
                                          const ImportOptions& options);

/// The facts about a file of the cache that a list shows.
struct PreparedFacts {
  std::string scene_file;  ///< in printable ASCII
  std::uint64_t triangles = 0;
  std::string build;  ///< `scene_build` of the program that wrote it
};

/// Reads these facts. Returns a fault if the header, the facts or the texts are damaged; the other
/// sections are not read.
base::Result<PreparedFacts> read_prepared_facts(int fd);

}  // namespace camway::scene
