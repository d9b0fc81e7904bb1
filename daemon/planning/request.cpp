// SPDX-License-Identifier: MIT
#include "daemon/planning/request.h"

#include <cmath>

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

std::string PlanRequest::name_of(std::string_view path) const {
  return spelling ? spelling(path) : std::string(path);
}

geometry::Vec3 direction_of(const geometry::Vec3& vector) {
  // Scaled first, so that squares neither overflow nor vanish.
  const double largest = vector.cwiseAbs().maxCoeff();
  if (!vector.allFinite() || largest == 0.0) return vector;
  if (std::abs(vector.squaredNorm() - 1.0) <= kUnitLengthError) return vector;
  const geometry::Vec3 scaled = vector / largest;
  return scaled / scaled.norm();
}

}  // namespace camway::planning
