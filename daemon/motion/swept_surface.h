// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "daemon/motion/camera.h"
#include "daemon/motion/path.h"

namespace camway::motion {

/// A vertex of the tessellated swept surface, annotated with its parameter on the motion.
struct SweptVertex {
  geometry::Vec3 position_W;
  double time_s;
};

/// A triangle of one of the four ruled surfaces between adjacent corner curves.
struct SweptTriangle {
  std::array<SweptVertex, 3> vertices;
  int side;  ///< 0..3: the surface between corner curves `side` and `(side + 1) % 4`

  [[nodiscard]] geometry::Triangle triangle() const {
    return {vertices[0].position_W, vertices[1].position_W, vertices[2].position_W};
  }
  [[nodiscard]] double first_time_s() const;  ///< lowest parameter of a vertex
  [[nodiscard]] double last_time_s() const;   ///< highest parameter of a vertex
};

/// The surface swept by the outline of the near quadrilateral over [t_begin_s, t_end_s]
/// (Ptacek & Johnstone 2006, section 2), sampled to triangles that stay within `chord_error_m` of
/// it. Sorted by lowest parameter.
std::vector<SweptTriangle> tessellate_swept_surface(const Path& path, const Corners& corners_C,
                                                    double chord_error_m, double t_begin_s,
                                                    double t_end_s);

}  // namespace camway::motion
