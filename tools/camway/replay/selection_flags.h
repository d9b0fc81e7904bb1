// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

#include "tools/camway/replay/selection.h"

namespace camway::tools {

/// Adds the options that select requests of a session: --from, --to, --id, --client, --scene-name
/// and --status.
void add_selection_flags(CLI::App& command, Selection& selection);

}  // namespace camway::tools
