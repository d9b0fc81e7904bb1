// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/planning/request.h"
#include "daemon/planning/result.h"
#include "daemon/scene/import/import.h"
#include "tools/json/json_document.h"

/// The files of planning: requests and responses as JSON. Angles are degrees there and radians
/// in memory; everything else has the same units on both sides.
namespace camway::tools {

/// A quaternion whose computed squared length is this close to 1 is of unit length as far as
/// doubles can tell: rounding the four coefficients changes it by at most 2 eps, and computing it
/// (four squares, three sums) by at most 2.5 eps. It keeps its bits when read; others are
/// normalised.
inline constexpr double kUnitQuaternionError = 5 * 2.220446049250313e-16;

/// How to read the scene's file. What is not set has the default of `scene::ImportOptions`.
struct SceneReading {
  std::optional<double> scale;  ///< metres per unit of the file [Limit: 0 < value]
  std::optional<scene::UpAxis> up;
  std::optional<scene::UnknownSpace> unknown;
};

/// A request as a file says it: what to plan, and how to read its scene.
struct RequestFile : planning::PlanRequest {
  SceneReading reading;
  /// Whether a keyframe has its quaternion as `orientation_xyzw`: then the order is no oversight.
  bool says_xyzw = false;
};

/// Reads a request. Checked here: the form (types, lengths, missing fields), a quaternion that is
/// not zero, one of `orientation` and `orientation_xyzw`, time in all keyframes or in none, and
/// that no field is unknown, remarks apart
/// (`Field::allow_only`): to ignore one that a later version knows, or that is spelled wrongly,
/// could drop a required clearance. The camera may be left out where another body is given. Ranges
/// and order of times are `planning::validate`'s. `source` heads the error, e.g. `R.json:
/// keyframes[3].orientation: has length zero`. Keyframes count from 0.
Parsed<RequestFile> parse_plan_request(std::string_view text, std::string_view source);

/// The same from a file; "-" is standard input.
Parsed<RequestFile> read_plan_request(const std::string& file);

enum class TimingField {
  kWritten,
  kOmitted,  ///< so that responses of two runs can be compared byte by byte
};

/// What a response file says beside the result.
struct ResponseFormat {
  TimingField timing = TimingField::kWritten;
  std::string scene;         ///< name or file; omitted when empty
  std::string scene_digest;  ///< what the answer was computed on; omitted when empty
  std::vector<std::string>
      warnings;  ///< about the scene's import, a sentence each; omitted when empty
};

/// Writes a response, with keys in a fixed order, and every double so that reading gives the same
/// bits. A NaN or infinity, which JSON cannot hold, is our fault: then there is no value, and the
/// error names the field.
Parsed<std::string> write_plan_response(const planning::PlanResult& result,
                                        const ResponseFormat& format = {});

/// Reads a response back, bit for bit, but for the number of a witness's feature, whose name alone
/// is written, the witness of a correction's collision, which stands in `collisions`, and angles
/// (of corrections and measures), which may be off by a rounding. The segments are checked to be a
/// path: each at least as long as nothing, each beginning where the one before ends. Unknown fields
/// are ignored: later versions may say more.
Parsed<planning::PlanResult> parse_plan_response(std::string_view text, std::string_view source);

/// The same from a file; "-" is standard input.
Parsed<planning::PlanResult> read_plan_response(const std::string& file);

}  // namespace camway::tools
