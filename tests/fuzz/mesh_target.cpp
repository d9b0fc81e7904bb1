// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include "tests/fuzz/exercise_mesh.h"
#include "tests/fuzz/targets.h"

namespace camway::testing {
namespace {

/// The first byte selects the format of the others.
constexpr std::array<std::string_view, 4> kMeshExtensions = {".obj", ".off", ".ply", ".stl"};

bool exercise_mesh_file(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return false;
  return exercise_mesh(kMeshExtensions[bytes[0] % kMeshExtensions.size()],
                       as_text(bytes.subspan(1)));
}

std::vector<FuzzBytes> mesh_seeds() {
  std::vector<FuzzBytes> all;
  for (const auto& files : {sound_mesh_files(), malformed_mesh_files()}) {
    for (const MeshFile& file : files) {
      const auto kind = std::ranges::find(kMeshExtensions, file.extension);
      FuzzBytes bytes{static_cast<std::uint8_t>(kind - kMeshExtensions.begin())};
      bytes.insert(bytes.end(), file.bytes.begin(), file.bytes.end());
      all.push_back(std::move(bytes));
    }
  }
  return all;
}

}  // namespace

constinit const FuzzTarget kMeshTarget{"mesh", exercise_mesh_file, mesh_seeds, 40'000};

}  // namespace camway::testing
