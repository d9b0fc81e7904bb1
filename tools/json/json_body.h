// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/motion/body/body.h"
#include "tools/json/json_document.h"

namespace camway::tools {

/// Reads the `body` of a request: an object with a `type` and what that type needs, in metres and
/// in the camera frame.
///
///     {"type": "camera"}
///     {"type": "box", "size": [x, y, z], "center": [x, y, z]}      center may be left out
///     {"type": "sphere", "radius": r, "center": [x, y, z]}         likewise
///     {"type": "convex", "points": [[x, y, z], ...]}               or "pieces": [[[x, y, z], ...],
///     ...]
///     {"type": "mesh", "vertices": [[x, y, z], ...], "triangles": [[i, j, k], ...]}
///
/// Nothing for a camera, and where the field fails. Ranges are `planning::validate`'s.
std::optional<motion::BodyShape> read_body(const Field& field);

}  // namespace camway::tools
