// SPDX-License-Identifier: MIT
#include "tools/view/responses.h"

namespace camway::view {

std::vector<std::pair<std::string, std::string>> common_headers() {
  return {{"Content-Security-Policy", std::string(kPolicy)},
          {"X-Content-Type-Options", "nosniff"},
          {"Referrer-Policy", "no-referrer"},
          {"Cross-Origin-Resource-Policy", "same-origin"},
          {"Cache-Control", "no-store"}};
}

http::Response to_response(Answer answer) {
  http::Response response{answer.code, "application/json", {}, {}};
  response.body = answer.code == code::kOk ? std::move(answer.json) : error_json(answer.error);
  if (!response.body.ends_with('\n')) response.body += '\n';
  return response;
}

http::Response refusal(int code, std::string error) {
  return to_response(failure(code, std::move(error)));
}

http::Response picture_response(std::string picture) {
  // The picture has style attributes, which its policy has to allow where it is opened alone.
  return {code::kOk,
          "image/svg+xml",
          std::move(picture),
          {{"Content-Security-Policy", std::string(kPolicy) + "; style-src 'unsafe-inline'"}}};
}

}  // namespace camway::view
