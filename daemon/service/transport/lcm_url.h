// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace camway::service {

/// The parts of an LCM url that matter to us.
struct LcmNetwork {
  std::string url;
  bool multicast = false;  ///< provider "udpm"; what follows holds only then
  std::string group = "239.255.76.67";
  std::uint16_t port = 7667;
  int ttl = 0;                                       ///< 0: this host only
  std::optional<std::int64_t> receive_buffer_bytes;  ///< "recv_buf_size"
  std::string fault;  ///< what makes no sense in it, of which LCM says little; empty if all does
};

/// Reads `url`, e.g. "udpm://239.255.76.67:7667?ttl=0". A provider must be one that can send and
/// receive; of others than udpm nothing else is looked at. Stricter than LCM, which takes a ttl
/// that is no number for 0 and an option that it does not know for none. [Source: lcm_udpm.c of LCM
/// 1.3.1]
LcmNetwork parse_lcm_url(const std::string& url);

}  // namespace camway::service
