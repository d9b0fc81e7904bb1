// SPDX-License-Identifier: MIT
//
// Writes the files that the fuzzer of mesh readers starts from: make_mesh_corpus FOLDER
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include "tests/fuzz/exercise_mesh.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: make_mesh_corpus FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  constexpr std::array<std::string_view, 4> kExtensions = {".obj", ".off", ".ply", ".stl"};
  int number = 0;
  for (const auto& files :
       {camway::testing::sound_mesh_files(), camway::testing::malformed_mesh_files()}) {
    for (const camway::testing::MeshFile& file : files) {
      const auto kind = std::find(kExtensions.begin(), kExtensions.end(), file.extension);
      std::ofstream stream(folder / (std::to_string(number++) + file.extension), std::ios::binary);
      stream.put(static_cast<char>(kind - kExtensions.begin()));
      stream << file.bytes;
    }
  }
  return 0;
}
