// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/geometry/bounds.h"
#include "daemon/motion/path/path.h"
#include "tools/json/json_document.h"

/// Paths as JSON, from Camway or from other programs.
namespace camway::tools {

/// A path file. A response of Camway is one; `{"segments": [...]}` is the smallest one.
struct PathFile {
  motion::Path path;
  /// Times at which the path passes its given keyframes, in their order: the times of the keyframes
  /// that are not marked as inserted. Empty if one of these has no time.
  std::vector<double> keyframe_times_s;
  std::string scene_digest;  ///< digest of the scene that it was made for; empty if unknown
  /// Near distance that it was made for, divided by the request's. [Limit: 0 < value <= 1]
  double near_scale = 1.0;
  geometry::Bounds bounds;  ///< bounds that it was made for
  bool is_slowed = false;   ///< whether it has later times than those asked for
};

/// Reads a path (`parse_as`, `read_as`). The member `segments` is required. A segment with an
/// unknown field is an error, except for remarks (`Field::allow_only`): a field such as `weights`
/// or `knots` would describe another curve than the one that is proved. Checks the form, that each
/// segment ends after it begins, and that it begins when the one before ends;
/// `planning::find_fault` checks the numbers. `keyframes` (with `time` and `origin`: "given" or
/// "inserted"), `scene_digest`, `bounds`, `near_scale` and `time_scale` are optional. Unknown
/// fields outside of the segments are ignored, because they cannot change what is proved.
void read_value(const Field& root, PathFile& file);

/// Reads a list of segments. Each must end after it begins, and begin when the one before ends.
/// Ignores unknown fields.
std::vector<motion::Segment> read_segments(const Field& list);

}  // namespace camway::tools
