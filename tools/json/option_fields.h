// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace camway::tools {

/// Returns the table of the options of a request for programs that show them, the one that the page
/// of requests has: `{"fields": [{"name": ..., "type": ..., "help": ..., ...}, ...]}`. Types are
/// `number`, `count`, `boolean`, `choice`, `vector` and `object`, which has `fields` of its own.
/// Angles are in degrees, as in request files.
std::string option_fields_json();

}  // namespace camway::tools
