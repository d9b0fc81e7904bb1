// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace camway::cli_support {

/// Returns whether the command line is `PROGRAM --help-tree`. The flag is for the build, which
/// makes the manual and the completions of shells with it, so no help shows it.
bool asks_for_help_tree(int argc, const char* const* argv);

/// Returns all that `app` and its subcommands say in their help, as a line of JSON. A command has
/// `name`, `description`, `footer`, `options` and `commands`. An option has `names` (`--scale`;
/// empty for a positional, whose word is `word`), `form` (of its value; empty for a switch),
/// `check` (the values that it takes: "above 0", "a|b"), `description`, `default`, `group`,
/// `required`, `repeats`, `needs` and `excludes`.
std::string help_tree(const CLI::App& app);

}  // namespace camway::cli_support
