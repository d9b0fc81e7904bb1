// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace camway::service {

/// Serves one page of text over HTTP on a thread of its own, to few at a time, who are cut off when
/// they are slow; everything else is refused. The only place that knows the HTTP library
/// (libmicrohttpd). Ends, and waits for its thread, when it is destroyed.
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

/// A page, or why there is none, e.g. "cannot listen on 127.0.0.1 port 9464: Address already in
/// use".
struct OpenedHttpPage {
  std::unique_ptr<HttpPage> page;
  std::string error;  ///< empty exactly when `page` is set
};

/// Serves what `text` gives, called anew for each request by the page's thread; it must not throw.
/// `path`: "/metrics". `type`: what the text is, as HTTP says it.
OpenedHttpPage open_http_page(const HttpAddress& address, std::string path, std::string type,
                              std::function<std::string()> text);

}  // namespace camway::service
