// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/motion/body/body.h"
#include "daemon/planning/request.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tools/camway/check/path_search.h"

namespace camway::tools {

/// A path and all that it is checked against, read and judged.
struct CheckInput {
  planning::PlanRequest request;
  motion::Path path;
  std::string response_file;                ///< where the path is from
  std::vector<motion::Keyframe> keyframes;  ///< of the request, with times; empty if nobody says
  std::optional<motion::Body> body;         ///< set
  std::shared_ptr<const scene::Snapshot> snapshot;
  std::string made_for_digest;  ///< of the scene that the path was made for; empty if not known
  double near_scale = 1.0;      ///< near distance that it was made for, as a share of the request's
  geometry::Bounds bounds;      ///< that the body must not leave
};

/// What the user should know beside the verdict, a sentence each: that the path was made for
/// another scene, that the body is too small for the tolerance, what the import of the scene left
/// out or rounded.
std::vector<std::string> check_warnings(const CheckInput& input, const PathSearch& search);

/// The verdict with what it rests on, for a program: README.md has the fields.
nlohmann::ordered_json check_json(const CheckInput& input, const PathSearch& search);

/// The same for a person, lines with an end each.
std::string check_text(const CheckInput& input, const PathSearch& search);

/// Where on the body a contact is, to follow what is touched: "at edge 2", "at its inside".
std::string at_feature(const std::string& feature);

}  // namespace camway::tools
