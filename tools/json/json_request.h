// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/planning/request/request.h"
#include "daemon/scene/import/import.h"
#include "tools/json/json_document.h"

/// Planning requests as JSON files. Angles are degrees in files and radians in memory; all other
/// units are the same.
namespace camway::tools {

/// Options for reading the scene's file. Unset ones have the default of `scene::ImportOptions`.
struct SceneReading {
  std::optional<double> scale;  ///< metres per unit of the file [Limit: 0 < value]
  std::optional<scene::UpAxis> up;
  std::optional<scene::UnknownSpace> unknown;
  std::optional<double> voxel_m;  ///< edge of a cloud's voxels [Limit: 1e-9 <= value <= 1e9]
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
  /// Whether `import` wrote the keyframes, of a format that says the order of its quaternions.
  bool has_imported_order = false;
};

/// Reads a request (`parse_as`, `read_as`). Checks the form (types, lengths, missing fields), that
/// quaternions are not zero, that a keyframe has one of `orientation` and `orientation_xyzw`, that
/// all keyframes have a time or none has, and that no field is unknown except for remarks
/// (`Field::allow_only`): ignoring an unknown field could drop a required clearance. The camera may
/// be left out if there is another body. `planning::validate` checks the ranges and the order of
/// times. Keyframes count from 0 in errors.
void read_value(const Field& root, RequestFile& request);

/// Returns a request as JSON text, which reads back to the same request; an angle may be off by a
/// rounding. Options that have their default are left out. JSON cannot hold NaN or infinity: the
/// error names the field that has one.
base::Result<std::string> write_plan_request(const planning::PlanRequest& request);

/// Reads the members `scale`, `up`, `unknown` and `voxel_m` of an object, each of which it may
/// lack. Ignores others.
void read_value(const Field& field, SceneReading& reading);

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

}  // namespace camway::tools
