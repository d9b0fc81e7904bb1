// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <camway/body_t.hpp>

#include "daemon/motion/body/body.h"

namespace camway::service {

/// The body of a request. A near quadrilateral has its numbers in the request's camera.
body_t wire_body(const motion::BodyShape& shape);

/// The shape of `wire`; nothing if it is the near quadrilateral of the request's camera. With an
/// error where the form is wrong, e.g. "body.type: 9 is unknown"; sizes and counts are judged by
/// `planning::validate`.
struct ConvertedBody {
  std::optional<motion::BodyShape> shape;
  std::string error;
};
ConvertedBody body_of(const body_t& wire);

}  // namespace camway::service
