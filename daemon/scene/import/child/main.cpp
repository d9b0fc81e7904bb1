// SPDX-License-Identifier: MIT

/// camway-import FILE MEMORY_BYTES CPU_SECONDS [cameras]: reads FILE and writes the record of
/// `record_layout.h` to file descriptor 3. OBJ, OFF, PLY, STL, UniGrafix, Bezier patches, clouds of
/// points and voxels of splats are read by our own readers, occupancy maps by OctoMap, all else by
/// assimp. Started by `import_mesh` only. The only program that sees assimp; a process of its own,
/// because a file of a few bytes can make assimp crash or take all memory.

#include <string_view>

#include "daemon/scene/import/child/assimp_reader.h"
#include "daemon/scene/import/child/scene_file.h"
#include "daemon/scene/import/common/import_process_main.h"
#include "daemon/scene/import/record/record_layout.h"

int main(int argc, char** argv) {
  namespace scene = camway::scene;
  const bool wants_cameras =
      argc == 5 && argv[4] == std::string_view(scene::import_record::kCamerasArgument);
  scene::import_process::run(
      wants_cameras ? 4 : argc, argv, [] {},
      wants_cameras ? scene::import_cameras_with_assimp : scene::import_scene_file);
}
