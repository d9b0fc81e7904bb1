// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"
#include "daemon/scene/import/import.h"
#include "tools/json/json_document.h"

/// Planning requests, responses and paths as JSON files. Paths may be from other programs. Angles
/// are degrees in files and radians in memory; all other units are the same.
namespace camway::tools {

/// Options for reading the scene's file. Unset ones have the default of `scene::ImportOptions`.
struct SceneReading {
  std::optional<double> scale;  ///< metres per unit of the file [Limit: 0 < value]
  std::optional<scene::UpAxis> up;
  std::optional<scene::UnknownSpace> unknown;
};

/// A mesh file that is the body of a request.
struct BodyFile {
  std::string file;    ///< relative to the request's folder
  double scale = 1.0;  ///< metres per unit of the file [Limit: 0 < value]
  bool solid = false;
};

/// A request file: the planning request, and the options for reading its scene.
struct RequestFile : planning::PlanRequest {
  SceneReading reading;
  /// Set if the body is a mesh file. Then `body` is a mesh without triangles, until someone reads
  /// the file (`read_request`).
  std::optional<BodyFile> body_file;
  /// Whether a keyframe has an `orientation_xyzw`, which shows that its order is intended.
  bool says_xyzw = false;
};

/// Reads a request (`parse_as`, `read_as`). Checks the form (types, lengths, missing fields), that
/// quaternions are not zero, that a keyframe has one of `orientation` and `orientation_xyzw`, that
/// all keyframes have a time or none has, and that no field is unknown except for remarks
/// (`Field::allow_only`): ignoring an unknown field could drop a required clearance. The camera may
/// be left out if there is another body. `planning::validate` checks the ranges and the order of
/// times. Keyframes count from 0 in errors.
void read_value(const Field& root, RequestFile& request);

/// Reads the `options` of a request. A missing option has its default. `planning::visit_table`
/// has the names of the options, and their old names, which are read as well. An example is
///
///     {"deadline_s": 5, "orientation": {"policy": "level", "up": [0, 0, 1], "max_turn_deg": 20},
///      "limits": {"speed_m_per_s": 2, "retime": true}, "bounds": {"max": [10, null, 3]}}
///
/// Directions have any length. Members that another policy of orientation uses are refused, because
/// ignoring them would drop a wish.
void read_value(const Field& field, planning::PlanOptions& options);

/// Returns the spelling of a request's members in files, for messages about it. For example
/// "camera.fov_x" becomes "camera.fov_x_deg", because files have degrees. A member that the file
/// has by an old name has that name in messages.
planning::FieldSpelling json_spelling(const DocumentNotes& notes = {});

/// Content of a response file beside the result.
struct ResponseFormat {
  bool has_timing = true;             ///< false: responses of two runs compare byte by byte
  std::string scene;                  ///< name or file; omitted when empty
  std::string scene_digest;           ///< digest of the scene of the answer; omitted when empty
  std::vector<std::string> warnings;  ///< sentences about the scene's import; omitted when empty
};

/// Returns a response as JSON text, with keys in a fixed order and doubles that read back to the
/// same bits. JSON cannot hold NaN or infinity: a result with one is a program fault, for which the
/// error names the field.
base::Result<std::string> write_plan_response(const planning::PlanResult& result,
                                              const ResponseFormat& format = {});

/// Reads a response (`parse_as`, `read_as`) back to the same bits, with three exceptions: of a
/// witness's feature only the name is written, not the number; the witness of a correction's
/// collision is only in `collisions`; angles of corrections and measures may be off by a rounding.
/// Checks that the segments are a path: each ends after it begins, and begins where the one before
/// ends. Ignores unknown fields, which later versions may have.
void read_value(const Field& root, planning::PlanResult& result);

/// A path file: a response of which little but the path is known. A response of Camway is one;
/// `{"segments": [...]}` is the smallest one. Read are the path, its bounds and scales, and of each
/// keyframe the origin and, if it is a given one, the time: "not a number" if it has none.
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
