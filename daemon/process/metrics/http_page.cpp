// SPDX-License-Identifier: MIT
#include "daemon/process/metrics/http_page.h"

#include <chrono>
#include <utility>

namespace camway::process {
namespace {

http::Response answer(const HttpContent& content, const http::Request& request) {
  http::Response response;
  if (request.method != "GET" && request.method != "HEAD") {
    response.status = 405;
    response.body = "only GET and HEAD\n";
    response.headers = {{"Allow", "GET, HEAD"}};
  } else if (request.target.substr(0, request.target.find('?')) != content.path) {
    response.status = 404;
    response.body = "see " + content.path + "\n";
  } else {
    response.type = content.type;
    response.body = content.text();
  }
  return response;
}

}  // namespace

base::Result<std::unique_ptr<http::Server>> open_http_page(const http::Address& address,
                                                           HttpContent content,
                                                           const HttpLimits& limits) {
  http::Handlers handlers;
  handlers.on_full = content.on_full;
  handlers.on_request = [content = std::move(content)](const http::Request& request,
                                                       const http::Reply& reply) {
    reply(answer(content, request));
  };
  http::Limits server_limits;
  server_limits.connections = limits.connections;
  server_limits.patience = std::chrono::seconds(limits.idle_s);
  return http::Server::open(address, std::move(handlers), server_limits);
}

}  // namespace camway::process
