// SPDX-License-Identifier: MIT
#include "daemon/service/transport/lcm_url.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <string_view>
#include <system_error>

namespace camway::service {
namespace {

constexpr std::string_view kMulticast = "udpm";
/// LCM also has "file", which either reads or writes.
constexpr std::array<std::string_view, 4> kProviders{kMulticast, "mpudpm", "tcpq", "memq"};

/// Reads a whole number from `least` to `most`. Returns an error or an empty text.
template <class Number>
std::string read_number(std::string_view name, std::string_view text, std::int64_t least,
                        std::int64_t most, Number& number) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < least || value > most) {
    return fmt::format("{} '{}' must be a whole number from {} to {}", name, text, least, most);
  }
  number = static_cast<Number>(value);
  return {};
}

/// Applies one `key=value` of a url of udpm. Returns an error or an empty text.
std::string apply_option(std::string_view option, LcmNetwork& network) {
  constexpr int kLargestTtl = std::numeric_limits<std::uint8_t>::max();
  const std::size_t equals = std::min(option.find('='), option.size());
  const std::string_view key = option.substr(0, equals);
  const std::string_view value = option.substr(std::min(equals + 1, option.size()));
  if (key == "ttl") return read_number(key, value, 0, kLargestTtl, network.ttl);
  if (key == "recv_buf_size") {
    return read_number(key, value, 1, std::numeric_limits<int>::max(),
                       network.receive_buffer_bytes);
  }
  if (key == "transmit_only") return {};  // LCM ignores it by now
  return fmt::format("'{}' is no option of {}; ttl and recv_buf_size are", key, kMulticast);
}

bool is_multicast_group(const std::string& text) {
  in_addr address{};
  return ::inet_pton(AF_INET, text.c_str(), &address) == 1 && IN_MULTICAST(ntohl(address.s_addr));
}

/// Applies the GROUP[:PORT] of a url of udpm. Returns an error or an empty text.
std::string apply_group(std::string_view text, LcmNetwork& network) {
  if (text.empty()) return {};  // LCM's own group
  const std::size_t colon = std::min(text.find(':'), text.size());
  network.group = text.substr(0, colon);
  if (!is_multicast_group(network.group)) {
    return fmt::format(
        "'{}' is no multicast group: an IPv4 address from 224.0.0.0 to "
        "239.255.255.255",
        network.group);
  }
  if (colon == text.size()) return {};
  return read_number("port", text.substr(colon + 1), 1, std::numeric_limits<std::uint16_t>::max(),
                     network.port);
}

}  // namespace

LcmNetwork parse_lcm_url(const std::string& url) {
  constexpr std::string_view kColon = "://";
  LcmNetwork network;
  network.url = url;
  const std::size_t scheme = url.find(kColon);
  const std::string_view provider = std::string_view(url).substr(0, scheme);
  if (scheme == std::string::npos || std::ranges::find(kProviders, provider) == kProviders.end()) {
    network.fault = fmt::format(
        "must begin with a provider of LCM that sends and receives, as in "
        "udpm:// ({})",
        fmt::join(kProviders, ", "));
    return network;
  }
  network.multicast = provider == kMulticast;
  if (!network.multicast) return network;
  const std::string_view rest = std::string_view(url).substr(scheme + kColon.size());
  const std::size_t question = std::min(rest.find('?'), rest.size());
  network.fault = apply_group(rest.substr(0, question), network);
  std::string_view options = rest.substr(std::min(question + 1, rest.size()));
  while (!options.empty() && network.fault.empty()) {
    const std::size_t end = std::min(options.find('&'), options.size());
    network.fault = apply_option(options.substr(0, end), network);
    options.remove_prefix(std::min(end + 1, options.size()));
  }
  return network;
}

}  // namespace camway::service
