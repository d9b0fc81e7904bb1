// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "lcmtypes/wire/channels.h"

namespace camway::fleet {

/// Longest id of a front or a planner, and longest name of a fleet.
inline constexpr std::size_t kMaxIdLength = 32;

/// Returns whether `text` matches [A-Za-z0-9_-]{1,32}. None of these characters is special in
/// subjects.
constexpr bool is_id(std::string_view text) { return wire::is_plain_name(text, kMaxIdLength); }

/// The subjects of a fleet's messages. Requires `is_id` of its name and of all ids.
struct Subjects {
  std::string fleet = "camway";

  [[nodiscard]] std::string plan(std::string_view planner_id) const {
    return (fleet + ".plan.").append(planner_id);
  }
  [[nodiscard]] std::string answer(std::string_view front_id) const {
    return (fleet + ".answer.").append(front_id);
  }
  [[nodiscard]] std::string front(std::string_view front_id) const {
    return (fleet + ".front.").append(front_id);
  }
  [[nodiscard]] std::string planner() const { return fleet + ".planner"; }
};

}  // namespace camway::fleet
