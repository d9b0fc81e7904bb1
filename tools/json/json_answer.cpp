// SPDX-License-Identifier: MIT
#include <utility>

#include "daemon/planning/result/members.h"
#include "tools/json/json_io.h"
#include "tools/json/json_reader.h"

namespace camway::tools {

using planning::may_lack;
using planning::PlanResult;

namespace {

/// Reads a list of segments. Each must end after it begins, and begin when the one before ends.
/// Ignores unknown fields.
void read_path(const Field& list, motion::Path& path) {
  std::vector<motion::Segment> segments;
  read_list(list, segments, [&](const Field& item, motion::Segment& segment) {
    read_value(item, segment);
    if (!(segment.t1_s > segment.t0_s)) item.member("t1").fail("must be above t0");
    if (segments.size() > 1 && segment.t0_s != segments[segments.size() - 2].t1_s) {
      item.member("t0").fail("must equal t1 of the segment before");
    }
  });
  // A path requires valid segments.
  if (!list.failed()) path = motion::Path(std::move(segments));
}

/// Returns the times of given keyframes; none if one has no time.
std::vector<double> read_keyframe_times(const Field& list) {
  std::vector<double> times_s;
  bool all_timed = true;
  const std::size_t count = list.size();
  for (std::size_t i = 0; i < count && !list.failed(); ++i) {
    const Field item = list.element(i);
    const JsonReader io(item);
    auto origin = motion::KeyframeOrigin::kGiven;
    std::optional<double> time_s;
    io(may_lack("origin"), origin);
    if (origin == motion::KeyframeOrigin::kInserted) continue;
    io(may_lack("time"), time_s);
    if (time_s) times_s.push_back(*time_s);
    all_timed = all_timed && time_s;
  }
  if (!all_timed) times_s.clear();
  return times_s;
}

}  // namespace

void read_value(const Field& root, PlanResult& result) {
  const JsonReader io(root);
  planning::head_members(io, result);
  if (const auto list = root.optional_member("segments")) read_path(*list, result.path);
  io(may_lack("keyframes"), result.keyframes);
  planning::report_members(io, result);
  io(may_lack("timing_ms"), result.timing);
}

void read_value(const Field& root, PathFile& file) {
  const Field list = root.member("segments");
  const std::size_t count = list.size();
  for (std::size_t i = 0; i < count && !list.failed(); ++i) {
    list.element(i).allow_only({"t0", "t1", "position", "orientation"});
  }
  read_path(list, file.path);
  if (const auto keyframes = root.optional_member("keyframes")) {
    file.keyframe_times_s = read_keyframe_times(*keyframes);
  }
  double time_scale = 1.0;
  const JsonReader io(root);
  io(may_lack("scene_digest"), file.scene_digest);
  io(may_lack("bounds"), file.bounds);
  io(may_lack("time_scale"), time_scale);
  io(may_lack("near_scale"), file.near_scale);
  file.is_slowed = time_scale != 1.0;
  if (const auto fault = geometry::fault_in(file.bounds)) {
    root.member("bounds").fail(fault->field + " " + fault->reason);
  }
  if (!(file.near_scale > 0.0 && file.near_scale <= 1.0)) {
    root.member("near_scale").fail_number("be above 0 and at most 1");
  }
}

}  // namespace camway::tools
