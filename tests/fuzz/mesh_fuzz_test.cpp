// SPDX-License-Identifier: MIT
//
// Valid files, formerly fatal files, and parts of both. Mutants are in targets_test.cpp.
#include <gtest/gtest.h>

#include "tests/fuzz/exercise_mesh.h"

namespace camway::testing {
namespace {

TEST(MeshFuzz, SoundFilesAreRead) {
  for (const MeshFile& file : sound_mesh_files()) {
    EXPECT_TRUE(exercise_mesh(file.extension, file.bytes)) << file.extension << "\n" << file.bytes;
  }
}

TEST(MeshFuzz, MalformedFilesBreakNoPromise) {
  for (const MeshFile& file : malformed_mesh_files()) {
    const bool read = exercise_mesh(file.extension, file.bytes);
    EXPECT_TRUE(read || file.extension != ".obj") << "any text is an OBJ file";
  }
}

TEST(MeshFuzz, NoFileIsReadBeyondItsEnd) {
  for (const MeshFile& file : sound_mesh_files()) {
    std::size_t refused = 0;
    for (std::size_t size = 0; size < file.bytes.size(); ++size) {
      // A separate copy, so that a sanitizer notices a read of one byte too many.
      refused += exercise_mesh(file.extension, std::string(file.bytes, 0, size)) ? 0U : 1U;
    }
    EXPECT_TRUE(refused > 0 || file.extension == ".obj") << file.extension << "\n" << file.bytes;
  }
}

}  // namespace
}  // namespace camway::testing
