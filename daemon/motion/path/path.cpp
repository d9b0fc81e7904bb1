// SPDX-License-Identifier: MIT
#include "daemon/motion/path/path.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace camway::motion {

Path::Path(std::vector<Segment> segments) : segments_(std::move(segments)) {
  assert(std::ranges::all_of(segments_, [](const Segment& s) { return s.t0_s < s.t1_s; }));
  assert(std::ranges::adjacent_find(segments_, [](const Segment& a, const Segment& b) {
           return a.t1_s != b.t0_s;
         }) == segments_.end());
}

double Path::begin_s() const {
  assert(!empty());
  return segments_.front().t0_s;
}

double Path::end_s() const {
  assert(!empty());
  return segments_.back().t1_s;
}

std::size_t Path::segment_index(double time_s) const {
  assert(!empty());
  const auto later =
      std::ranges::upper_bound(segments_, time_s, std::ranges::less{}, &Segment::t0_s);
  const auto begun = static_cast<std::size_t>(later - segments_.begin());
  return begun == 0 ? 0 : begun - 1;
}

Pose Path::pose(double time_s) const {
  const Segment& segment = segments_[segment_index(time_s)];
  return pose_at(segment, segment_parameter(segment, time_s));
}

}  // namespace camway::motion
