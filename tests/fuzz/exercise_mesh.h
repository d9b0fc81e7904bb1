// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace camway::testing {

/// Reads `bytes` as a file whose name ends in `extension`, and aborts where a promise of
/// `mesh_reader.h` is broken: what comes back is a refusal with a reason, or a record that holds
/// together and is in proportion to the file. Returns whether it was read.
bool exercise_mesh(std::string_view extension, std::string_view bytes);

struct MeshFile {
  std::string extension;
  std::string bytes;
};

/// Files that once were, or could be, the end of a reader: cut short, with counts of billions or
/// below zero, indices out of range, numbers that no double holds, NULs, lines without an end.
std::vector<MeshFile> malformed_mesh_files();

/// Sound files of all formats and encodings, small.
std::vector<MeshFile> sound_mesh_files();

}  // namespace camway::testing
