// SPDX-License-Identifier: MIT
#include "tools/camway/replay/signed_event.h"

#include <utility>

#include "lcmtypes/wire/envelope.h"

namespace camway::tools {

std::optional<wire::Distrust> open_event(const wire::MessageKeys* keys, record::LogEvent& event) {
  if (keys != nullptr) {
    wire::MessageAuth::Opened opened = wire::open_recorded(*keys, event.channel, event.data);
    if (!opened.message) return opened.why;
    event.data = std::move(*opened.message);
    return std::nullopt;
  }
  std::optional<std::vector<std::uint8_t>> payload = wire::payload_unchecked(event.data);
  if (!payload) return wire::Distrust::kBroken;
  event.data = std::move(*payload);
  return std::nullopt;
}

}  // namespace camway::tools
