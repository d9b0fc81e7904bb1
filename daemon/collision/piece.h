// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/motion/camera.h"
#include "daemon/motion/segment.h"
#include "daemon/scene/scene_index.h"

namespace camway::collision {

/// A stretch of a segment. Kept as parameters of the whole, not as control points of its own, so
/// that rounding does not add up over sub-divisions.
struct Piece {
  const motion::Segment* segment;
  double u0;
  double u1;

  [[nodiscard]] double middle() const { return 0.5 * (u0 + u1); }
  [[nodiscard]] Piece left() const { return {segment, u0, middle()}; }
  [[nodiscard]] Piece right() const { return {segment, middle(), u1}; }
  [[nodiscard]] double begin_s() const { return motion::segment_time_s(*segment, u0); }
  [[nodiscard]] double end_s() const { return motion::segment_time_s(*segment, u1); }
  /// A piece so short that its middle is one of its ends cannot be split.
  [[nodiscard]] bool splittable() const { return middle() > u0 && middle() < u1; }
};

/// What one distance query tells about all of a piece.
struct Look {
  /// No point of the body is further than this from where it is at the middle.
  double deviation_m;
  /// Bound of the rounding that separates the computed distance from the true one: of the corners
  /// and of the distance itself.
  double rounding_m;
  /// Computed distance at the middle, 0 where they touch; nothing if the scene is further away than
  /// `deviation_m + rounding_m + beyond_m`.
  std::optional<double> distance_m;
};

/// Asks how far the scene is from the near quadrilateral in the middle of `piece`, as far as it
/// matters for a distance of `beyond_m` to be kept all over the piece.
///
/// The proof that a piece is free: let D be the true distance at the middle and d the computed one,
/// |D - d| <= rounding. Every point of the body is, anywhere on the piece, within `deviation_m` of
/// where it is at the middle. So the distance is everywhere at least D - deviation, and if d is
/// greater than deviation + rounding + beyond, it is everywhere greater than `beyond_m`.
Look look_at(const scene::SceneIndex& index, const motion::Corners& corners_C, double body_radius_m,
             const Piece& piece, double beyond_m);

}  // namespace camway::collision
