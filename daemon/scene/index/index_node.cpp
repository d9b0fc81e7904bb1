// SPDX-License-Identifier: MIT
#include "daemon/scene/index/index_node.h"

#include <algorithm>
#include <cmath>

#include "daemon/geometry/rounding.h"

namespace camway::scene {

using geometry::Box;

namespace {

/// The finest steps of which 254 cover `extent`: one is left for rounding a side outwards.
int exponent_for(double extent) {
  constexpr double kUsed = ByteFrame::kSteps - 1;
  if (!(extent / kUsed > power_of_two(ByteFrame::kMinExponent))) return ByteFrame::kMinExponent;
  const int power = std::ilogb(extent / kUsed);
  return kUsed * power_of_two(power) < extent ? power + 1 : power;
}

}  // namespace

ByteFrame::ByteFrame(const Box& box) {
  // Distances beyond 2^60 steps are clamped (see box_gaps), so flat or small boxes get no finer
  // steps than they need.
  constexpr double kFinestOfExtent = 0x1p-32;
  constexpr double kFinestOfCoordinate = 0x1p-48;
  const double extent_m = box.sizes().maxCoeff();
  const double largest_m = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  const double least_m = std::max(kFinestOfExtent * extent_m, kFinestOfCoordinate * largest_m);
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    origin[axis] = box.min()[k];
    const double side_m = box.max()[k] - box.min()[k];
    exponent[axis] = static_cast<std::int16_t>(exponent_for(std::max(side_m, least_m)));
  }
}

ByteBox ByteFrame::outside(const Box& box) const {
  ByteBox bytes;
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    const double steps_per_m = power_of_two(-exponent[axis]);
    const double low = (box.min()[k] - origin[axis]) * steps_per_m;
    const double high = (box.max()[k] - origin[axis]) * steps_per_m;
    // Not negative, so that a conversion rounds down.
    const int below = static_cast<int>(std::clamp(low, 0.0, double{kSteps}));
    const int above = static_cast<int>(std::clamp(high, 0.0, double{kSteps}));
    bytes.low[axis] = static_cast<std::uint8_t>(below);
    bytes.high[axis] =
        static_cast<std::uint8_t>(above < kSteps && above < high ? above + 1 : above);
  }
  return bytes;
}

Box ByteFrame::box_of(const ByteBox& bytes) const {
  Box box;
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    const double step_m = power_of_two(exponent[axis]);
    const double low = origin[axis] + bytes.low[axis] * step_m;
    const double high = origin[axis] + bytes.high[axis] * step_m;
    // The sum is rounded once, relative to itself, and the side once more when it is moved.
    const double margin = 4.0 * geometry::kUnitRoundoff * std::max(std::abs(low), std::abs(high)) +
                          kByteBoxError * step_m;
    box.min()[k] = low - margin;
    box.max()[k] = high + margin;
  }
  return box;
}

}  // namespace camway::scene
