// SPDX-License-Identifier: MIT

/// forked_import: `camway-import` for many files; see forked_reader.h.

#include "daemon/scene/import/child/assimp_reader.h"
#include "daemon/scene/import/child/scene_file.h"
#include "tests/fuzz/files/forked_reader.h"

int main() {
  return camway::testing::serve_forked(
      {[] {}, camway::scene::import_scene_file, camway::scene::import_cameras_with_assimp});
}
