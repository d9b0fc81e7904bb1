// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace camway::scene::inventor {

/// Reads an Open Inventor or VRML file and writes a record of it or of a refusal. Returns the exit
/// code. Requires `start_coin`. For the import process alone: Coin trusts its files.
int import_inventor_file(const std::string& file);

}  // namespace camway::scene::inventor
