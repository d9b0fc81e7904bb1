// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace camway::scene::cad {

/// Reads a STEP or IGES file and writes a record of it or of a refusal. Returns the exit code.
/// Requires `start_cad`. For the import process alone: Open CASCADE may crash.
int import_cad_file(const std::string& file);

}  // namespace camway::scene::cad
