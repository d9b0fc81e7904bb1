// SPDX-License-Identifier: MIT
#include "daemon/collision/piece.h"

#include <array>

#include "daemon/collision/near_quad.h"
#include "daemon/motion/corner_rounding.h"
#include "daemon/motion/motion_bound.h"

namespace camway::collision {

namespace {

// Three sums, each of which rounds by half of this at most, relative to their result.
constexpr double kRoundUp = 1.0 + 2.0 * 2.220446049250313e-16;

}  // namespace

Look look_at(const scene::SceneIndex& index, const motion::Corners& corners_C, double body_radius_m,
             const Piece& piece, double beyond_m) {
  const motion::Segment& segment = *piece.segment;
  const double deviation_m =
      motion::deviation_m(motion::motion_bound(segment, piece.u0, piece.u1), body_radius_m);
  const std::array<geometry::Triangle, 2> quad =
      near_quad_triangles(motion::corners_W(corners_C, motion::pose_at(segment, piece.middle())));
  const double rounding_m = motion::corner_rounding_m(segment, piece.middle(), body_radius_m) +
                            index.nearest_error_m(quad);
  const std::optional<scene::Nearest> nearest =
      index.nearest(quad, (deviation_m + rounding_m + beyond_m) * kRoundUp);
  if (!nearest) return {deviation_m, rounding_m, std::nullopt};
  return {deviation_m, rounding_m, nearest->distance_m};
}

}  // namespace camway::collision
