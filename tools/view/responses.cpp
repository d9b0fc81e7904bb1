// SPDX-License-Identifier: MIT
#include "tools/view/responses.h"

#include <fmt/format.h>

namespace camway::view {
namespace {

/// The policy of what is not the page: nothing is loaded from elsewhere.
constexpr std::string_view kPolicy =
    "default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; "
    "object-src 'none'";

/// The policy of the page. It unpacks meshes in WebAssembly, makes pictures, and asks the door.
/// 'self' does not mean sockets in every browser.
std::string page_policy(int port) {
  return fmt::format(
      "{0}; script-src 'self' 'wasm-unsafe-eval'; img-src 'self' data: blob:; "
      "connect-src 'self' ws://127.0.0.1:{1} ws://localhost:{1}",
      kPolicy, port);
}

/// Returns whether a client takes gzip. One that takes it and calls it worst gets it.
bool takes_gzip(std::string_view encodings) {
  const std::size_t at = encodings.find("gzip");
  if (at == std::string_view::npos) return false;
  const std::string_view rest = encodings.substr(at, encodings.find(',', at) - at);
  return !rest.ends_with("q=0") && !rest.ends_with("q=0.0");
}

}  // namespace

std::vector<std::pair<std::string, std::string>> common_headers() {
  return {{"Content-Security-Policy", std::string(kPolicy)},
          {"X-Content-Type-Options", "nosniff"},
          {"Referrer-Policy", "no-referrer"},
          {"Cross-Origin-Resource-Policy", "same-origin"},
          {"Cache-Control", "no-store"}};
}

http::Response to_response(Answer answer) {
  http::Response response{answer.code, "application/json", {}, {}};
  response.body = answer.code == code::kOk ? std::move(answer.json)
                                           : "{" + error_members(answer.code, answer.error) + "}";
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

http::Response file_response(const PageFile& file, std::string type, int port,
                             const http::Request& request) {
  http::Response response{
      code::kOk,
      std::move(type),
      {},
      {{"Content-Security-Policy", page_policy(port)}, {"Vary", "Accept-Encoding"}}};
  if (takes_gzip(request.header("accept-encoding"))) {
    response.body = file.gzip;
    response.headers.emplace_back("Content-Encoding", "gzip");
  } else {
    response.body = file.text;
  }
  return response;
}

}  // namespace camway::view
