// SPDX-License-Identifier: MIT
//
// A libFuzzer program for one target, which CAMWAY_FUZZ_TARGET names. With the environment variable
// CAMWAY_WRITE_SEEDS it writes the corpus to that folder and ends.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/fuzz/targets.h"

using camway::testing::CAMWAY_FUZZ_TARGET;

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  const char* const folder = std::getenv("CAMWAY_WRITE_SEEDS");
  if (folder == nullptr) return 0;
  std::filesystem::create_directories(folder);
  int number = 0;
  for (const camway::testing::FuzzBytes& seed : CAMWAY_FUZZ_TARGET.seeds()) {
    std::ofstream out(std::filesystem::path(folder) / ("seed_" + std::to_string(number++)),
                      std::ios::binary);
    out << camway::testing::as_text(seed);
  }
  std::exit(EXIT_SUCCESS);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  CAMWAY_FUZZ_TARGET.exercise({data, size});
  return 0;
}
