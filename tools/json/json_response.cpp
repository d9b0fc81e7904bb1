// SPDX-License-Identifier: MIT
#include "tools/json/json_response.h"

#include <limits>
#include <utility>

#include "daemon/planning/result/result_members.h"
#include "tools/json/json_reader.h"

namespace camway::tools {

using planning::may_lack;
using planning::PlanResult;

namespace {

/// Reads a list of segments. Each must end after it begins, and begin when the one before ends.
/// Ignores unknown fields of segments, unless `is_strict`.
void read_path(const Field& list, bool is_strict, motion::Path& path) {
  std::vector<motion::Segment> segments;
  read_list(list, segments, [&](const Field& item, motion::Segment& segment) {
    if (is_strict) {
      allow_only(item, {}, [&](const auto& visit) { planning::members(visit, segment); });
    }
    read_value(item, segment);
    if (!(segment.t1_s > segment.t0_s)) item.member("t1").fail("must be above t0");
    if (segments.size() > 1 && segment.t0_s != segments[segments.size() - 2].t1_s) {
      item.member("t0").fail("must equal t1 of the segment before");
    }
  });
  // A path requires valid segments.
  if (!list.failed()) path = motion::Path(std::move(segments));
}

/// Reads what a path has of a keyframe: its time and its origin.
void read_passed(const Field& item, motion::Keyframe& keyframe) {
  const JsonReader io(item);
  keyframe.time_s = std::numeric_limits<double>::quiet_NaN();
  io(may_lack("origin"), keyframe.origin);
  io(may_lack("time"), keyframe.time_s);
}

}  // namespace

void read_value(const Field& root, PlanResult& result) {
  const JsonReader io(root);
  planning::head_members(io, result);
  if (const auto list = root.optional_member("segments")) read_path(*list, false, result.path);
  io(may_lack("keyframes"), result.keyframes);
  planning::report_members(io, result);
  io(may_lack("timing_ms"), result.timing);
}

void read_value(const Field& root, ResponseFile& file) {
  read_value(root, static_cast<PlanResult&>(file));
  const JsonReader io(root);
  io(may_lack("scene_digest"), file.scene_digest);
  io(may_lack("scene_reading"), file.scene_reading);
  io(may_lack("vertical_axis"), file.vertical_axis);
}

void read_value(const Field& root, PathFile& file) {
  read_path(root.member("segments"), true, file.path);
  const auto keyframes = root.optional_member("keyframes");
  if (keyframes) read_list(*keyframes, file.keyframes, read_passed);
  const JsonReader io(root);
  io(may_lack("scene_digest"), file.scene_digest);
  io(may_lack("bounds"), file.bounds);
  io(may_lack("time_scale"), file.time_scale);
  io(may_lack("near_scale"), file.near_scale);
  if (const auto fault = geometry::fault_in(file.bounds)) {
    root.member("bounds").fail(fault->field + " " + fault->reason);
  }
  if (!(file.near_scale > 0.0 && file.near_scale <= 1.0)) {
    root.member("near_scale").fail_number("be above 0 and at most 1");
  }
}

}  // namespace camway::tools
