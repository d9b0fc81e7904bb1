// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/geometry/bounds.h"
#include "daemon/motion/path/path.h"
#include "tools/json/json_document.h"

/// Paths as JSON, whoever wrote them.
namespace camway::tools {

/// What a path from anywhere says of itself. A response of ours is one; so is
/// `{"segments": [...]}`.
struct PathFile {
  motion::Path path;
  /// When the path means to pass the keyframes that it was made for, in their order: the times of
  /// those in `keyframes` that are not marked as inserted. Empty if one of them has no time.
  std::vector<double> keyframe_times_s;
  std::string scene_digest;  ///< of the scene that it was made for; empty if it does not say
  /// The near distance that it was made for, as a share of the request's. [Limit: 0 < value <= 1]
  double near_scale = 1.0;
  geometry::Bounds bounds;  ///< that it was made within
};

/// Reads the path. `segments` has to be there and every field of a segment has to be known, remarks
/// apart (`Field::allow_only`): what a stranger's `weights` or `knots` change, we would prove of
/// another path. Checked here: the form, that each segment is longer than nothing and begins when
/// the one before ends; the numbers are `planning::find_fault`'s. `keyframes` (with `time` and
/// `origin`: "given" or "inserted"), `scene_digest` and `near_scale` may be left out. All else is
/// ignored, for it cannot change what is proved.
Parsed<PathFile> parse_path_file(std::string_view text, std::string_view source);

/// The same from a file; "-" is standard input.
Parsed<PathFile> read_path_file(const std::string& file);

/// Reads a list of segments, each at least as long as nothing and beginning where the one before
/// ends. Ignores unknown fields.
std::vector<motion::Segment> read_segments(const Field& list);

/// "given", "inserted", or an error.
motion::KeyframeOrigin read_origin(const Field& field);

}  // namespace camway::tools
