// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <string>

#include "tools/camway/common/commands.h"

namespace camway::tools {

/// Returns ", bodies within ..." with the box that no body may leave in the scene; nothing without
/// one.
std::string bounds_note(const SceneInfo& scene);

/// Prints a line about the scene.
void print_scene(const SceneInfo& scene);

/// Prints the scenes, objects and revisions of an answer, or the reason why it has none. Returns
/// the exit code. `key_file` is that of the command line, for advice on refused signatures.
ExitCode print_answer(const SceneAnswer& answer, const std::string& key_file);

}  // namespace camway::tools
