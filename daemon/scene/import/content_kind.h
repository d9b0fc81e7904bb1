// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace camway::scene {

/// Bytes at the begin of a file that say what it is.
inline constexpr std::size_t kContentBegin = 4096;

/// Returns what is wrong where the begin of a file is that of another format than its name says:
/// "its content is Open Inventor: name it .iv". Empty if nothing is, or the content is of no kind
/// that is known. Readers would take it for a damaged file of the format of its name.
std::string content_fault(std::string_view extension, std::string_view begin);

}  // namespace camway::scene
