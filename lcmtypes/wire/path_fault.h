// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <camway/segment_t.hpp>

namespace camway::wire {

inline bool is_finite(const segment_t& segment) {
  const auto finite = [](double value) { return std::isfinite(value); };
  return finite(segment.t0_s) && finite(segment.t1_s) &&
         std::all_of(&segment.position_m[0][0], &segment.position_m[0][0] + 4 * 3, finite) &&
         std::all_of(&segment.orientation_wxyz[0][0], &segment.orientation_wxyz[0][0] + 7 * 4,
                     finite);
}

/// Returns why the segments of an answer are no path, for example
/// "segments[2]: does not begin where the one before ends"; empty if they are one.
inline std::string path_fault(const std::vector<segment_t>& segments) {
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::string name = "segments[" + std::to_string(i) + "]: ";
    if (!is_finite(segments[i])) return name + "holds numbers that are not finite";
    if (!(segments[i].t0_s < segments[i].t1_s)) return name + "does not end after it begins";
    // The daemon sends the same number twice, so that there is neither gap nor overlap.
    if (i > 0 && segments[i - 1].t1_s != segments[i].t0_s) {
      return name + "does not begin where the one before ends";
    }
  }
  return {};
}

}  // namespace camway::wire
