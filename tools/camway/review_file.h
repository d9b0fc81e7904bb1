// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "daemon/scene/snapshot/snapshot.h"

namespace camway::tools {

/// Writes a plan in its scene as a page that is one file (`view::make_review`). Takes the names of
/// the files of the request, of its response and of the page. Returns why that is not possible;
/// empty on success.
std::string write_review(const scene::Snapshot& snapshot, const std::string& request_file,
                         const std::string& response_file, const std::string& page_file);

}  // namespace camway::tools
