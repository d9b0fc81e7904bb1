// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/changed_ranges.h"

#include <algorithm>
#include <cmath>

namespace camway::bench {

namespace {

/// Two cubics that agree at four times are the same.
bool is_changed(const motion::CubicPath& path, const motion::CubicPath& original,
                const motion::CubicPiece& piece) {
  constexpr int kTimes = 4;
  for (int i = 0; i < kTimes; ++i) {
    const double share = static_cast<double>(i) / (kTimes - 1);
    const double time_s = std::lerp(piece.t0_s, piece.t1_s, share);
    const motion::CubicPoint now = path.at(time_s);
    const motion::CubicPoint before = original.at(time_s);
    if ((now.position - before.position).norm() > kSame) return true;
    if ((now.image - before.image).norm() > kSame) return true;
  }
  return false;
}

}  // namespace

std::vector<TimeRange> changed_ranges(const motion::CubicPath& path,
                                      const motion::CubicPath& original) {
  std::vector<TimeRange> ranges;
  for (const motion::CubicPiece& piece : path.pieces) {
    if (is_changed(path, original, piece)) ranges.push_back({piece.t0_s, piece.t1_s});
  }
  return joined(std::move(ranges));
}

std::vector<TimeRange> joined(std::vector<TimeRange> ranges) {
  std::ranges::sort(ranges, {}, &TimeRange::begin_s);
  std::vector<TimeRange> unions;
  for (const TimeRange& range : ranges) {
    if (unions.empty() || unions.back().end_s < range.begin_s) {
      unions.push_back(range);
    } else {
      unions.back().end_s = std::max(unions.back().end_s, range.end_s);
    }
  }
  return unions;
}

}  // namespace camway::bench
