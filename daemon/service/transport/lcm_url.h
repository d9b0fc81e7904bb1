// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace camway::service {

/// The parts of an LCM url that matter here.
struct LcmNetwork {
  std::string url;
  bool multicast = false;  ///< provider "udpm"; the members below are set only then
  std::string group = "239.255.76.67";
  std::uint16_t port = 7667;
  int ttl = 0;                                       ///< 0: this host only
  std::optional<std::int64_t> receive_buffer_bytes;  ///< "recv_buf_size"
  std::string fault;  ///< error in the url, of which LCM says little; empty if there is none
};

/// Reads `url`, e.g. "udpm://239.255.76.67:7667?ttl=0". Requires a provider that can send and
/// receive; reads nothing further if that is not udpm. Stricter than LCM, which reads a ttl that is
/// no number as 0 and ignores unknown options. [Source: lcm_udpm.c of LCM 1.3.1]
LcmNetwork parse_lcm_url(const std::string& url);

}  // namespace camway::service
