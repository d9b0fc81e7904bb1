// SPDX-License-Identifier: MIT
#include "tools/json/json_path.h"

#include <utility>

#include "tools/json/json_reader.h"

namespace camway::tools {
namespace {

void refuse_unknown_fields(const Field& segments) {
  const std::size_t count = segments.size();
  for (std::size_t i = 0; i < count && !segments.failed(); ++i) {
    segments.element(i).allow_only({"t0", "t1", "position", "orientation"});
  }
}

std::vector<double> read_keyframe_times(const Field& list) {
  std::vector<double> times_s;
  bool all_timed = true;
  const std::size_t count = list.size();
  for (std::size_t i = 0; i < count && !list.failed(); ++i) {
    const Field item = list.element(i);
    auto origin = motion::KeyframeOrigin::kGiven;
    if (const auto field = item.optional_member("origin")) read_value(*field, origin);
    if (origin == motion::KeyframeOrigin::kInserted) continue;
    const auto time = item.optional_member("time");
    if (time) times_s.push_back(time->number());
    all_timed = all_timed && time;
  }
  if (!all_timed) times_s.clear();
  return times_s;
}

PathFile read_path(const Field& root) {
  PathFile file;
  const Field list = root.member("segments");
  refuse_unknown_fields(list);
  std::vector<motion::Segment> segments = read_segments(list);
  // A path requires valid segments.
  if (!root.failed()) file.path = motion::Path(std::move(segments));
  if (const auto keyframes = root.optional_member("keyframes")) {
    file.keyframe_times_s = read_keyframe_times(*keyframes);
  }
  if (const auto digest = root.optional_member("scene_digest")) file.scene_digest = digest->text();
  if (const auto bounds = root.optional_member("bounds")) {
    read_value(*bounds, file.bounds);
    if (const auto fault = geometry::fault_in(file.bounds))
      bounds->fail(fault->field + " " + fault->reason);
  }
  if (const auto scale = root.optional_member("time_scale")) {
    file.is_slowed = scale->number() != 1.0;
  }
  if (const auto scale = root.optional_member("near_scale")) {
    file.near_scale = scale->number();
    if (!(file.near_scale > 0.0 && file.near_scale <= 1.0)) {
      scale->fail_number("be above 0 and at most 1");
    }
  }
  return file;
}

}  // namespace

std::vector<motion::Segment> read_segments(const Field& list) {
  std::vector<motion::Segment> segments;
  const std::size_t count = list.size();
  for (std::size_t i = 0; i < count && !list.failed(); ++i) {
    const Field item = list.element(i);
    motion::Segment segment;
    read_value(item, segment);
    if (!(segment.t1_s > segment.t0_s)) item.member("t1").fail("must be above t0");
    if (i > 0 && segment.t0_s != segments.back().t1_s) {
      item.member("t0").fail("must equal t1 of the segment before");
    }
    segments.push_back(segment);
  }
  return segments;
}

base::Result<PathFile> parse_path_file(std::string_view text, std::string_view source) {
  return parse_as(read_path, text, source);
}

base::Result<PathFile> read_path_file(const std::string& file) { return read_as(read_path, file); }

}  // namespace camway::tools
