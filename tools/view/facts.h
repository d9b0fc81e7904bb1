// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "daemon/geometry/bounds.h"
#include "daemon/geometry/types.h"

namespace camway::view {

using Numbers3 = std::array<double, 3>;

/// A scene, as the door shows it.
struct SceneFacts {
  std::string name;
  std::int64_t revision = 0;  ///< increases with every change
  std::string digest;         ///< equal scenes have equal digests
  std::int64_t triangles = 0;
  Numbers3 min_m{};                      ///< lower corner of its bounding box
  Numbers3 max_m{};                      ///< upper corner of its bounding box
  geometry::OptionalBounds body_bounds;  ///< box that no body may leave
};

/// An object of a scene, as the door shows it.
struct ObjectFacts {
  std::string name;
  std::string kind;  ///< "mesh", "box", ...
  std::string digest;
  /// Digest of its mesh in its own frame, which moves do not change; empty where that is not known.
  std::string mesh_digest;
  std::int64_t triangles = 0;
  Numbers3 position_m{};
  std::array<double, 4> orientation_wxyz{1, 0, 0, 0};
  Numbers3 min_m{};  ///< lower corner of its bounding box in the world
  Numbers3 max_m{};  ///< upper corner of its bounding box in the world
};

/// Returns `{"scenes": [...]}`.
std::string scenes_json(const std::vector<SceneFacts>& scenes);
/// Returns `{"scene": {...}, "objects": [...], "warnings": ...}`; the last is left out if empty.
std::string objects_json(const SceneFacts& scene, const std::vector<ObjectFacts>& objects,
                         const std::string& warnings = {});

/// Returns `{"revision": ..., "triangles": {"INDEX": [[x, y, z], ...], ...}}`. [Units: metres]
std::string triangles_json(std::int64_t revision,
                           const std::map<std::int64_t, geometry::Triangle>& triangles);

}  // namespace camway::view
