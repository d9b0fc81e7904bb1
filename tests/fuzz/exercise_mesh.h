// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace camway::testing {

/// Reads `bytes` as a file with this extension. Returns whether it was accepted. Aborts the process
/// if a promise of `mesh_reader.h` is broken: the result must be a refusal with a reason, or a
/// consistent record whose size is in proportion to the file.
bool exercise_mesh(std::string_view extension, std::string_view bytes);

struct MeshFile {
  std::string extension;
  std::string bytes;
};

/// Returns files that crashed a reader once, or could: truncated, with counts of billions or below
/// zero, indices out of range, numbers beyond doubles, NULs, or lines without an end.
std::vector<MeshFile> malformed_mesh_files();

/// Returns small valid files of all formats and encodings.
std::vector<MeshFile> sound_mesh_files();

}  // namespace camway::testing
