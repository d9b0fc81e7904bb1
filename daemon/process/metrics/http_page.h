// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "daemon/process/metrics/http_address.h"

namespace camway::process {

/// Serves one page of text over HTTP on a thread of its own, to a limited number of connections at
/// a time. Closes idle connections. Further connections wait for a free place. Refuses other paths
/// and methods. The only place that sees the HTTP library (libmicrohttpd). The destructor ends and
/// joins the thread.
class HttpPage {
 public:
  virtual ~HttpPage() = default;
  /// Returns the port on which it listens.
  [[nodiscard]] virtual int port() const = 0;
};

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

/// Returns the page, or an error, e.g. "cannot listen on 127.0.0.1 port 9464: Address already in
/// use". The page is not null.
base::Result<std::unique_ptr<HttpPage>> open_http_page(const HttpAddress& address,
                                                       HttpContent content,
                                                       const HttpLimits& limits = {});

}  // namespace camway::process
