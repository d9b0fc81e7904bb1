// SPDX-License-Identifier: MIT
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tests/fuzz/exercise_mesh.h"

/// The first byte says which format the others are of.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array<std::string_view, 4> kExtensions = {".obj", ".off", ".ply", ".stl"};
  if (size == 0) return 0;
  camway::testing::exercise_mesh(kExtensions[data[0] % kExtensions.size()],
                                 {reinterpret_cast<const char*>(data) + 1, size - 1});
  return 0;
}
