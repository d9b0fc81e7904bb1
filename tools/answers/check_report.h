// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/motion/body/body.h"
#include "daemon/planning/request/request.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tools/answers/path_search.h"

namespace camway::tools {

/// A path to check, with everything that it is checked against.
struct CheckInput {
  planning::PlanRequest request;
  motion::Path path;
  std::string response_file;                ///< file that the path was read from
  std::vector<motion::Keyframe> keyframes;  ///< with times; empty if the times are unknown
  std::optional<motion::Body> body;         ///< always set
  std::shared_ptr<const scene::Snapshot> snapshot;
  std::string made_for_digest;  ///< digest of the scene of the response; empty if unknown
  double near_scale = 1.0;      ///< near distance that it was made for, divided by the request's
  geometry::Bounds bounds;      ///< box that the body must not leave
};

/// Returns warnings beside the verdict, a sentence each: that the path was made for another scene,
/// that the body is too small for the tolerance, and what the import of the scene left out or
/// rounded.
std::vector<std::string> check_warnings(const CheckInput& input, const PathSearch& search);

/// Returns the verdict and its grounds as JSON.
nlohmann::ordered_json check_json(const CheckInput& input, const PathSearch& search);

/// Returns the verdict and its grounds as text; each line ends with a newline.
std::string check_text(const CheckInput& input, const PathSearch& search);

/// Returns the place of a contact on the body, for the end of a sentence: "at edge 2", "at its
/// inside".
std::string at_feature(const std::string& feature);

}  // namespace camway::tools
