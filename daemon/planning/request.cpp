// SPDX-License-Identifier: MIT
#include "daemon/planning/request.h"

namespace camway::planning {

namespace {

constexpr std::string_view kLadder = "ladder";
constexpr std::string_view kKeyframeInsertion = "keyframe_insertion";

}  // namespace

std::string_view to_string(Method method) {
  switch (method) {
    case Method::kLadder:
      return kLadder;
    case Method::kKeyframeInsertion:
      return kKeyframeInsertion;
  }
  return "unknown";
}

std::optional<Method> method_from_string(std::string_view text) {
  if (text == kLadder) return Method::kLadder;
  if (text == kKeyframeInsertion) return Method::kKeyframeInsertion;
  return std::nullopt;
}

}  // namespace camway::planning
