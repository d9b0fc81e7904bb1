// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "daemon/http/server.h"

namespace camway::view {

/// The rules of who may use the door.
struct Lock {
  int port = 0;
  std::string token;
};

/// Returns the path of a target, without its query.
std::string_view path_of(std::string_view target);

/// Returns a parameter of the query of a target, as it was sent; empty if there is none.
std::string_view parameter_of(std::string_view target, std::string_view name);

/// Returns why a request is refused, a sentence; empty if it may pass.
///
/// - `Host` must be 127.0.0.1 or localhost with the port, or else the page that asks was reached by
///   a name that somebody else made lead here.
/// - `Origin`, if there is one, must be that of the door: no page from elsewhere may ask.
/// - The token must come as `Authorization: Bearer`, as cookie, or, for the first page and the
///   WebSocket, as `?token=`: other users of this machine reach the port, too.
std::string why_refused(const http::Request& request, const Lock& lock);

/// Returns the header that gives a browser the token of its first page, so that it can ask for
/// more. The name has the port, since browsers send cookies to all ports of a host.
std::string cookie_for(const Lock& lock);

}  // namespace camway::view
