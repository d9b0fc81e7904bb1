// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "daemon/http/server.h"

namespace camway::process {

struct HttpLimits {
  int connections = 16;  ///< connections at a time [Limit: 1 <= value <= 1000]
  int idle_s = 5;  ///< silence after which a connection is closed [Limit: 1 <= value <= 86400]
};

/// Content of a page. Both functions are called on the page's thread and must not throw.
struct HttpContent {
  std::string path;                         ///< "/metrics"
  std::string type;                         ///< content type of the text
  std::function<std::string()> text;        ///< called anew for each request
  std::function<void()> on_full = nullptr;  ///< called when no connection is free; may be null
};

/// Serves one page of text over HTTP; refuses other paths and methods. Closes idle connections;
/// further ones wait for a free place. Returns the server, or an error, e.g. "cannot listen on
/// 127.0.0.1 port 9464: Address already in use". The server is not null.
base::Result<std::unique_ptr<http::Server>> open_http_page(const http::Address& address,
                                                           HttpContent content,
                                                           const HttpLimits& limits = {});

}  // namespace camway::process
