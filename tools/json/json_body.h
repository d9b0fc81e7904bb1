// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/motion/body/body.h"
#include "tools/json/json_document.h"

namespace camway::tools {

/// Reads the `body` of a request: an object with a `type` and the members of that type
/// (`planning/request/body_members.h`), in metres and in the camera frame. `center` may be left
/// out.
///
///     {"type": "camera"}
///     {"type": "box", "size": [x, y, z], "center": [x, y, z]}
///     {"type": "sphere", "radius_m": r, "center": [x, y, z]}
///     {"type": "convex", "points": [[x, y, z], ...]}
///     {"type": "convex", "pieces": [[[x, y, z], ...], ...]}
///     {"type": "mesh", "vertices": [[x, y, z], ...], "triangles": [[i, j, k], ...]}
///
/// Returns nothing for a camera. Also returns nothing after an error, which `field` then holds
/// (`Field::failed`). `planning::validate` checks the ranges.
std::optional<motion::BodyShape> read_body(const Field& field);

}  // namespace camway::tools
