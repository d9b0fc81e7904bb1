// SPDX-License-Identifier: MIT
#include "daemon/service/scenes/request_digest.h"

#include <fmt/format.h>

#include "lcmtypes/wire/check.h"

namespace camway::service {

RequestDigest digest_of(scene_request_t request) {
  request.utime = 0;
  return digest_of_bytes(wire::encode(request));
}

std::string request_name(const scene_request_t& request) {
  const auto [high, low] = digest_of(request);
  return fmt::format("{}/{}/{:016x}{:016x}", request.client_id, request.request_id, high, low);
}

}  // namespace camway::service
