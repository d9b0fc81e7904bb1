// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <camway/body_t.hpp>

#include "daemon/base/result.h"
#include "daemon/motion/body/body.h"

namespace camway::messages {

/// Returns the message for a body. A near quadrilateral has its size in the request's camera.
body_t wire_body(const motion::BodyShape& shape);

/// Returns the shape of `wire`, or an error about its form, e.g. "body.type: 9 is unknown". The
/// shape is nothing if it is the near quadrilateral of the request's camera. Sizes and counts are
/// checked by `planning::validate`.
base::Result<std::optional<motion::BodyShape>> body_of(const body_t& wire);

}  // namespace camway::messages
