// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/planning/result/result.h"
#include "daemon/scene/import/record/import_options.h"
#include "daemon/scene/import/record/vertical_axis.h"
#include "tools/json/json_document.h"
#include "tools/json/json_request.h"

/// Responses and paths as JSON files. Paths may be from other programs. Angles are degrees in files
/// and radians in memory; all other units are the same.
namespace camway::tools {

/// Content of a response file beside the result.
struct ResponseFormat {
  bool has_timing = true;    ///< false: responses of two runs compare byte by byte
  std::string scene;         ///< name or file; omitted when empty
  std::string scene_digest;  ///< digest of the scene of the answer; omitted when empty
  /// How the scene's file was read; omitted when unknown.
  std::optional<scene::ImportOptions> scene_reading = {};
  std::optional<scene::VerticalAxis> vertical_axis = {};  ///< omitted when unknown
  std::vector<std::string> warnings;  ///< sentences about the scene's import; omitted when empty
};

/// Returns a response as JSON text, with keys in a fixed order and doubles that read back to the
/// same bits. JSON cannot hold NaN or infinity: a result with one is a program fault, for which the
/// error names the field.
base::Result<std::string> write_plan_response(const planning::PlanResult& result,
                                              const ResponseFormat& format = {});

/// Returns a path as JSON text, as the smallest path file: `{"segments": [...]}`. Fails as
/// `write_plan_response` does.
base::Result<std::string> write_path(const motion::Path& path);

/// Reads a response (`parse_as`, `read_as`) back to the same bits, with three exceptions: of a
/// witness's feature only the name is written, not the number; the witness of a correction's
/// collision is only in `collisions`; angles of corrections and measures may be off by a rounding.
/// Checks that the segments are a path: each ends after it begins, and begins where the one before
/// ends. Ignores unknown fields, which later versions may have.
void read_value(const Field& root, planning::PlanResult& result);

/// A response with what it says about its scene. A response of an earlier release, or of a daemon,
/// lacks some of it.
struct ResponseFile : planning::PlanResult {
  std::string scene_digest;    ///< empty if unknown
  SceneReading scene_reading;  ///< options that the scene was read with; unset if unknown
  std::optional<scene::VerticalAxis> vertical_axis;
};

/// Reads a response like a result, and the members about its scene.
void read_value(const Field& root, ResponseFile& file);

/// A path file: a response of which little but the path is known. A response of Camway is one;
/// `{"segments": [...]}` is the smallest one. Read are the path, its bounds and scales, and of each
/// keyframe the origin and the time: "not a number" if it has none.
struct PathFile : planning::PlanResult {
  std::string scene_digest;  ///< digest of the scene that it was made for; empty if unknown
};

/// Reads a path (`parse_as`, `read_as`). The member `segments` is required. A segment with an
/// unknown field is an error, except for remarks (`Field::allow_only`): a field such as `weights`
/// or `knots` would describe another curve than the one that is proved. Checks the form, that each
/// segment ends after it begins, and that it begins when the one before ends;
/// `planning::find_fault` checks the numbers. `keyframes` (with `time` and `origin`: "given" or
/// "inserted"), `scene_digest`, `bounds`, `near_scale` and `time_scale` are optional. Unknown
/// fields outside of the segments are ignored, because they cannot change what is proved.
void read_value(const Field& root, PathFile& file);

}  // namespace camway::tools
