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

/// Returns why a command that reads `inputs` cannot write `file`; empty if it can. A command asks
/// this before long work, and may ask again once it knows more of its inputs. Refused are a file
/// that `write_file` could not write now, a file that is one of the inputs under any name, and "-",
/// by which people mean standard output. Empty names among the inputs are skipped. Makes and
/// removes the temporary file of `write_file`; does not touch the old file.
std::string why_unwritable(const std::filesystem::path& file,
                           const std::vector<std::string>& inputs);

}  // namespace camway::tools
