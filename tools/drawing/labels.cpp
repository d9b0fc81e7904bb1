// SPDX-License-Identifier: MIT
#include "tools/drawing/labels.h"

#include <algorithm>
#include <array>

namespace camway::draw {

LabelPlacer::LabelPlacer(const Frame& frame)
    : frame_(PlanPoint(frame.x, frame.y),
             PlanPoint(frame.x + frame.width, frame.y + frame.height)) {}

void LabelPlacer::block(const PlanPoint& at, double half_px) {
  taken_.emplace_back(PlanPoint(at.array() - half_px), PlanPoint(at.array() + half_px));
}

std::optional<PlanBox> LabelPlacer::place(const PlanPoint& at, const PlanPoint& size) {
  constexpr std::array kDistances_px{8.0, 16.0, 26.0};
  // Above, below, right, left, then the corners.
  constexpr std::array<std::array<double, 2>, 8> kSides{
      {{0, -1}, {0, 1}, {1, 0}, {-1, 0}, {1, -1}, {-1, -1}, {1, 1}, {-1, 1}}};
  for (const double distance_px : kDistances_px) {
    for (const auto& [right, down] : kSides) {
      const PlanPoint side(right, down);
      const PlanPoint middle =
          at + side.cwiseProduct(PlanPoint(size / 2).array().matrix()) + distance_px * side;
      const PlanBox box(PlanPoint(middle - size / 2), PlanPoint(middle + size / 2));
      const bool is_free =
          std::ranges::none_of(taken_, [&](const PlanBox& other) { return other.intersects(box); });
      if (!is_free || !frame_.contains(box)) continue;
      taken_.push_back(box);
      return box;
    }
  }
  return std::nullopt;
}

}  // namespace camway::draw
