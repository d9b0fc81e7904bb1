// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "daemon/motion/path/segment.h"

namespace camway::motion {

/// The motion of a body: consecutive segments without gaps in time. A value type. Thread-safe to
/// read.
class Path {
 public:
  Path() = default;

  /// Requires `segments` in order of time with `segments[i].t1_s == segments[i+1].t0_s`.
  explicit Path(std::vector<Segment> segments);

  [[nodiscard]] bool empty() const { return segments_.empty(); }
  [[nodiscard]] std::span<const Segment> segments() const& { return segments_; }
  /// Deleted for temporaries: the span would outlive them.
  std::span<const Segment> segments() const&& = delete;
  /// This function and all below require that the path is not empty.
  [[nodiscard]] double begin_s() const;
  [[nodiscard]] double end_s() const;

  /// Returns the index of the segment that contains `time_s`; at a join the later one, outside of
  /// the path the nearest one.
  [[nodiscard]] std::size_t segment_index(double time_s) const;

  /// Returns the pose at `time_s`, clamped to the path's time span.
  [[nodiscard]] Pose pose(double time_s) const;

 private:
  std::vector<Segment> segments_;
};

}  // namespace camway::motion
