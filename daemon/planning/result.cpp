// SPDX-License-Identifier: MIT
#include "daemon/planning/result.h"

#include <array>
#include <utility>

namespace camway::planning {

namespace {

constexpr std::array<std::pair<Status, std::string_view>, 7> kStatusNames{{
    {Status::kOk, "ok"},
    {Status::kPartial, "partial"},
    {Status::kInfeasible, "infeasible"},
    {Status::kTimeout, "timeout"},
    {Status::kInvalid, "invalid"},
    {Status::kUnknownScene, "unknown_scene"},
    {Status::kInternalError, "internal_error"},
}};

}  // namespace

std::string_view to_string(Status status) {
  for (const auto& [value, name] : kStatusNames) {
    if (value == status) return name;
  }
  return "unknown";
}

std::optional<Status> status_from_string(std::string_view text) {
  for (const auto& [value, name] : kStatusNames) {
    if (name == text) return value;
  }
  return std::nullopt;
}

}  // namespace camway::planning
