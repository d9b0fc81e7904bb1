// SPDX-License-Identifier: MIT
#include "daemon/messages/text.h"

#include <algorithm>

#include <camway/occupancy_response_t.hpp>
#include <camway/plan_response_t.hpp>
#include <camway/scene_response_t.hpp>

#include "daemon/base/named_enum.h"
#include "daemon/planning/result/result.h"

namespace camway::messages {

std::string_view status_name(std::int32_t wire_status) {
  if (const auto status = base::value_of<planning::Status>(wire_status)) {
    return planning::to_string(*status);
  }
  if (wire_status == plan_response_t::STATUS_OVERLOADED) return "overloaded";
  if (wire_status == plan_response_t::STATUS_MALFORMED) return "malformed";
  if (wire_status == plan_response_t::STATUS_CANCELLED) return "cancelled";
  if (wire_status == plan_response_t::STATUS_LIMIT) return "limit";
  if (wire_status == plan_response_t::STATUS_OLD_SCENE) return "old_scene";
  if (wire_status == occupancy_response_t::STATUS_NO_MAP) return "no_map";
  if (wire_status == scene_response_t::STATUS_STOPPING) return "stopping";
  return kUnknownStatus;
}

std::string clipped(std::string_view text, std::size_t max_bytes) {
  std::size_t size = std::min({text.size(), max_bytes, text.find('\0')});
  // A byte 10xxxxxx continues a character; cutting before one would leave half of it.
  const auto continues = [&](std::size_t i) {
    return (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
  };
  if (size == max_bytes) {
    while (size > 0 && size < text.size() && continues(size)) --size;
  }
  return std::string(text.substr(0, size));
}

}  // namespace camway::messages
