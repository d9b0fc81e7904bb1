// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace camway::tools {

/// Writes a file completely or not at all: the bytes go to disk under another name in the same
/// folder, which then replaces the old file. A pipe, terminal or link is written directly. Returns
/// an error that names the file; empty on success.
std::string write_file(const std::filesystem::path& file, std::string_view bytes);

/// Returns why a name is none of an output file of a command that reads these files; empty if it
/// is:
/// "-", which commands that write other things to standard output do not take, and an input.
std::string why_no_output(const std::string& file, const std::vector<std::string>& inputs);

/// Returns why `write_file` could not write this file now; empty if it could; also where its name
/// is "-", by which people mean standard output. A command asks this before long work. Makes and
/// removes the temporary file of `write_file`; does not touch the old file.
std::string why_unwritable(const std::filesystem::path& file);

}  // namespace camway::tools
