// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/path.h"

namespace camway::paper {

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

/// The surface swept by the outline of the near quadrilateral over [t_begin_s, t_end_s] (clamped to
/// the path; empty if nothing is left): the four ruled surfaces between adjacent corner curves
/// (Ptacek & Johnstone 2006, section 2), sampled to triangles.
///
/// - `S(t, v) = (1 - v)·c_i(t) + v·c_j(t)` is within `chord_error_m` of the mesh of its strip, for
///   every t and v. That is proved, not sampled: corner curves against their chords by Bernstein
///   coefficients, the bilinear patch between two chords against its two triangles by a quarter of
///   its twist.
/// - All four surfaces are cut at the same parameters, found by repeated halving of segments, and
///   vertices at one parameter are equal bit for bit: strips and sides join without cracks.
/// - Triangles are in order of `first_time_s`, which grows from strip to strip; within a strip by
///   side, two each.
///
/// The error is not reduced below the rounding bound `kSweptRounding` times the size of the
/// coordinates. If more than `kMaxSweptStrips` strips beyond one per segment would be needed, the
/// whole surface is sampled again with a larger error, at least doubled, until it fits. If the
/// orientation numerator comes so close to zero that `kMaxSweptDepth` halvings do not prove it
/// positive, the bound does not hold. Requires `path` not to be empty and chord_error_m > 0.
std::vector<SweptTriangle> tessellate_swept_surface(const motion::Path& path,
                                                    const motion::Corners& corners_C,
                                                    double chord_error_m, double t_begin_s,
                                                    double t_end_s);

/// Rounding of a vertex and of an error bound, relative to the largest coordinate: the evaluation
/// of a pose (3 and 6 convex combinations of 3 roundings), a rotation and a sum, at both ends of a
/// strip.
inline constexpr double kSweptRounding = 64.0 * std::numeric_limits<double>::epsilon();

/// Largest number of strips, of 8 triangles each: about 14 MB and a few tenths of a second.
inline constexpr std::size_t kMaxSweptStrips = 16384;

/// Largest number of halvings of a segment.
inline constexpr int kMaxSweptDepth = 30;

}  // namespace camway::paper
