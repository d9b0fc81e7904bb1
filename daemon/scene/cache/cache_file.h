// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "daemon/base/result.h"
#include "daemon/scene/cache/prepared_scene.h"
#include "daemon/scene/cache/scene_key.h"

/// Reads and writes files that hold one prepared scene each; `cache_layout.h` has their layout.
namespace camway::scene {

/// Returns the size of the file that `write_prepared` makes.
std::uint64_t prepared_bytes(const std::string& scene_file, const PreparedScene& prepared);

/// Writes the scene into an empty file that is open for writing. `scene_file` names the file that
/// it was read from, for lists. Returns false if not all could be written.
bool write_prepared(int fd, const SceneKey& key, const std::string& scene_file,
                    const PreparedScene& prepared);

/// Reads a file that `write_prepared` made with this key in this build. `options` are those that
/// the key was made with. Returns a fault for any other file. Uses a size only after checking that
/// the file has so many bytes. Compares the digest of each section. Checks that an import could
/// have made the mesh, and that no query leaves the arrays of tree and field. Only the digests
/// cover that the boxes of the tree and the bounds of the field are correct.
///
/// Tree and field refer to the file, which is mapped into memory (`FileBytes`). Requires that
/// nobody writes into the file any more; it may be removed.
base::Result<PreparedScene> read_prepared(int fd, const SceneKey& key,
                                          const ImportOptions& options);

/// The metadata of a file of the cache, for lists.
struct PreparedMetadata {
  std::string scene_file;  ///< in printable ASCII
  double scale = 1.0;      ///< as `ImportOptions` has it
  UpAxis up = UpAxis::kAsInFile;
  std::uint64_t triangles = 0;
  std::string build;  ///< `scene_build` of the program that wrote it
};

/// Reads the metadata of a file. Returns a fault if its header, its metadata or its texts are
/// damaged. Does not read the other sections.
base::Result<PreparedMetadata> read_prepared_metadata(int fd);

}  // namespace camway::scene
