// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/http/server.h"
#include "tools/view/answer.h"
#include "tools/view/page_files.h"

/// Responses of the door over HTTP.
namespace camway::view {

/// Returns the headers of every response.
std::vector<std::pair<std::string, std::string>> common_headers();

/// Returns the response of an answer: its JSON, or the reason that there is none.
http::Response to_response(Answer answer);
/// Returns the response of a reason. [Limit: code != code::kOk]
http::Response refusal(int code, std::string error);
/// Returns a picture in SVG.
http::Response picture_response(std::string picture);
/// Returns a file of the page of the door on `port`, compressed if the request takes that.
http::Response file_response(const PageFile& file, std::string type, int port,
                             const http::Request& request);

}  // namespace camway::view
