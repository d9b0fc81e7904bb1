// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace camway::tools {

/// Writes a file whole or not at all: what was there before stays until all bytes are on the disk,
/// under another name beside it. What is no ordinary file (a pipe, a terminal, a link) is written
/// as it comes. Returns why it cannot be, naming the file; empty on success.
std::string write_file(const std::filesystem::path& file, std::string_view bytes);

/// Returns why `write_file` could not write this file now, naming it; empty if it could. For work
/// that takes long to be refused before it is begun. Makes and removes the file beside it, in which
/// `write_file` would begin; what was there before is not touched.
std::string why_unwritable(const std::filesystem::path& file);

}  // namespace camway::tools
