// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"
#include "daemon/scene/import/record/import_options.h"

namespace camway::scene {

/// Turns a point as the option asks. Exact.
inline geometry::Vec3 turned(const geometry::Vec3& p, UpAxis up) {
  switch (up) {
    case UpAxis::kZToY:
      return {p.x(), p.z(), -p.y()};
    case UpAxis::kYToZ:
      return {p.x(), -p.z(), p.y()};
    case UpAxis::kAsInFile:
      break;
  }
  return p;
}

}  // namespace camway::scene
