// SPDX-License-Identifier: MIT
//
// The fuzzer's entry point on mutants of a fixed seed, so that every build runs it.
#include <gtest/gtest.h>

#include "tests/fuzz/exercise_mesh.h"
#include "tests/service/message_mutation.h"
#include "tests/service/random_messages.h"

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
    for (std::size_t size = 0; size < file.bytes.size(); ++size) {
      // A copy of its own, so that a sanitizer sees one byte too many.
      exercise_mesh(file.extension, std::string(file.bytes, 0, size));
    }
  }
}

TEST(MeshFuzz, MutantsBreakNoPromise) {
  Random random(kSeed);
  std::vector<MeshFile> files = sound_mesh_files();
  for (MeshFile& file : malformed_mesh_files()) files.push_back(std::move(file));
  constexpr int kMutants = 40'000;
  int read = 0;
  for (int trial = 0; trial < kMutants; ++trial) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed << ", trial " << trial);
    const MeshFile& original = files[below(random, files.size())];
    if (original.bytes.size() > 20'000) continue;
    std::vector<std::uint8_t> bytes(original.bytes.begin(), original.bytes.end());
    mutate(bytes, random);
    read += exercise_mesh(original.extension, std::string(bytes.begin(), bytes.end())) ? 1 : 0;
  }
  EXPECT_GT(read, kMutants / 20) << "the mutants are too wild to reach the readers";
  EXPECT_LT(read, kMutants * 9 / 10);
}

}  // namespace
}  // namespace camway::testing
