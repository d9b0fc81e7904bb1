// SPDX-License-Identifier: MIT
#include "tools/view/access/access.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "tools/view/access/token.h"

namespace camway::view {
namespace {

std::vector<std::string_view> values_of(const http::Request& request, std::string_view name) {
  std::vector<std::string_view> values;
  for (const auto& [each, value] : request.headers) {
    if (each == name) values.push_back(value);
  }
  return values;
}

/// Returns the value of `name=value` in a list that `separator` divides; empty if there is none.
std::string_view value_in(std::string_view list, char separator, std::string_view name) {
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(separator), list.size());
    std::string_view item = list.substr(0, end);
    list.remove_prefix(std::min(end + 1, list.size()));
    while (item.starts_with(' ')) item.remove_prefix(1);
    if (item.size() > name.size() && item.starts_with(name) && item[name.size()] == '=') {
      return item.substr(name.size() + 1);
    }
  }
  return {};
}

std::string cookie_name(const Lock& lock) { return fmt::format("camway_{}", lock.port); }

bool takes_token_in_target(const http::Request& request) {
  const std::string_view path = path_of(request.target);
  return path == "/" || path == "/v1/socket";
}

bool has_token(const http::Request& request, const Lock& lock) {
  constexpr std::string_view kBearer = "Bearer ";
  for (const std::string_view value : values_of(request, "authorization")) {
    if (!value.starts_with(kBearer)) continue;
    if (is_same_secret(value.substr(kBearer.size()), lock.token)) return true;
  }
  for (const std::string_view cookies : values_of(request, "cookie")) {
    if (is_same_secret(value_in(cookies, ';', cookie_name(lock)), lock.token)) return true;
  }
  return takes_token_in_target(request) &&
         is_same_secret(parameter_of(request.target, "token"), lock.token);
}

}  // namespace

std::string_view path_of(std::string_view target) { return target.substr(0, target.find('?')); }

std::string_view parameter_of(std::string_view target, std::string_view name) {
  const std::size_t query = target.find('?');
  if (query == std::string_view::npos) return {};
  return value_in(target.substr(query + 1), '&', name);
}

std::string why_refused(const http::Request& request, const Lock& lock) {
  const std::vector<std::string_view> hosts = values_of(request, "host");
  const bool is_here =
      hosts.size() == 1 && (hosts.front() == fmt::format("127.0.0.1:{}", lock.port) ||
                            hosts.front() == fmt::format("localhost:{}", lock.port));
  if (!is_here) {
    return fmt::format("the Host of the request must be 127.0.0.1:{0} or localhost:{0}", lock.port);
  }
  for (const std::string_view origin : values_of(request, "origin")) {
    if (origin != fmt::format("http://{}", hosts.front())) {
      return "pages from elsewhere may not ask here: the Origin is another one";
    }
  }
  if (lock.token.empty() || !has_token(request, lock)) {
    return "the token is missing or wrong; it is in the URL that camway view printed, and goes "
           "into the header Authorization: Bearer TOKEN";
  }
  return {};
}

std::string cookie_for(const Lock& lock) {
  return fmt::format("{}={}; Path=/; SameSite=Strict; HttpOnly", cookie_name(lock), lock.token);
}

}  // namespace camway::view
