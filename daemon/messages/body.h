// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <camway/body_t.hpp>

#include "daemon/motion/body/body.h"

namespace camway::messages {

/// Returns the message for a body. A near quadrilateral has its size in the request's camera.
body_t wire_body(const motion::BodyShape& shape);

/// The shape of a message, or an error about its form, e.g. "body.type: 9 is unknown".
struct ConvertedBody {
  std::optional<motion::BodyShape> shape;
  std::string error;
};
/// Returns the shape of `wire`; no shape if it is the near quadrilateral of the request's camera.
/// Sizes and counts are checked by `planning::validate`.
ConvertedBody body_of(const body_t& wire);

}  // namespace camway::messages
