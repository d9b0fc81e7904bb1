// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace camway::tools {

/// Returns a `.glb`, the binary form of glTF 2.0, of a document and the content of its first
/// buffer, which may be empty. The document must give its length.
std::string glb_file(std::string document, std::string buffer);

}  // namespace camway::tools
