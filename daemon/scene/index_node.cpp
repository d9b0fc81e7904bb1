// SPDX-License-Identifier: MIT
#include "daemon/scene/index_node.h"

#include <algorithm>
#include <cmath>

#include "daemon/geometry/rounding.h"

namespace camway::scene {

using geometry::Box;

ByteFrame::ByteFrame(const Box& box) {
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    origin[axis] = box.min()[k];
    const double extent = box.max()[k] - box.min()[k];
    // One step more than the quotient, for the rounding of the difference and of a side outwards.
    int power =
        extent > 0.0 ? std::max(std::ilogb(extent / (kSteps - 1)), kMinExponent) : kMinExponent;
    if ((kSteps - 1) * power_of_two(power) < extent) ++power;
    exponent[axis] = static_cast<std::int16_t>(power);
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
