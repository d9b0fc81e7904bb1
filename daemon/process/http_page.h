// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace camway::service {

/// Serves one page of text over HTTP on a thread of its own, to few at a time, who are cut off when
/// they are idle; others wait until one of these is gone, and everything else is refused. The only
/// place that knows the HTTP library (libmicrohttpd). Ends, and waits for its thread, when it is
/// destroyed.
class HttpPage {
 public:
  virtual ~HttpPage() = default;
  /// The port it listens on.
  [[nodiscard]] virtual int port() const = 0;
};

struct HttpAddress {
  std::string ip = "127.0.0.1";  ///< IPv4 or IPv6, of this machine
  int port = 0;                  ///< 0: any that is free [Limit: 0 <= value <= 65535]
};

/// Whether `text` is an IPv4 or IPv6 address.
bool is_ip_address(const std::string& text);
/// Whether it is one that this machine has now, so that it could listen there. Looks at no port.
bool is_address_of_this_machine(const std::string& text);

struct HttpLimits {
  int connections = 16;  ///< at a time [Limit: 1 <= value <= 1000]
  int idle_s = 5;        ///< that a connection may be silent [Limit: 1 <= value <= 86400]
};

/// What a page says. Both are called by the page's thread and must not throw.
struct HttpContent {
  std::string path;                      ///< "/metrics"
  std::string type;                      ///< what the text is, as HTTP says it
  std::function<std::string()> text;     ///< called anew for each request
  std::function<void()> full = nullptr;  ///< as many are connected now as may be; may be null
};

/// A page, or why there is none, e.g. "cannot listen on 127.0.0.1 port 9464: Address already in
/// use".
struct OpenedHttpPage {
  std::unique_ptr<HttpPage> page;
  std::string error;  ///< empty exactly when `page` is set
};

OpenedHttpPage open_http_page(const HttpAddress& address, HttpContent content,
                              const HttpLimits& limits = {});

}  // namespace camway::service
