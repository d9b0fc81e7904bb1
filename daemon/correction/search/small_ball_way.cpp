// SPDX-License-Identifier: MIT
#include "daemon/correction/search/small_ball_way.h"

#include <optional>

#include "daemon/correction/search/ball_escape.h"

namespace camway::correction {

namespace {

using geometry::Vec3;
using motion::SignedPose;

// Chosen by measurement; none changes what is proved.
constexpr double kSmallestCell = 0.02;  // in radii of the body
// An end is in a narrow place if no ball of so many radii of the body fits anywhere near it.
constexpr double kNarrow = 3.0;
// About a second. No way out of a narrow place of the measured scenes takes more. Ways between
// rooms take up to 1'100'000 cells.
constexpr std::size_t kMostCellsIfNarrow = 400'000;

CellOptions options_for_body(double body_radius_m, double ball_radius_m, std::size_t max_cells) {
  return {.ball_radius_m = ball_radius_m,
          .smallest_m = kSmallestCell * body_radius_m,
          .max_cells = max_cells,
          .comfort_m = body_radius_m,
          .narrow_m = kNarrow * body_radius_m - ball_radius_m,
          .max_cells_if_narrow = kMostCellsIfNarrow};
}

}  // namespace

CellResult small_ball_way(FreeSpace& space, const SignedPose& from, const SignedPose& to,
                          double ball_share, std::size_t max_cells,
                          const base::Deadline& deadline) {
  const double radius_m = space.ball_radius_m();
  const double ball_radius_m = ball_share * radius_m;
  const std::optional<SignedPose> begin = ball_escape(space, from, ball_radius_m);
  const std::optional<SignedPose> end = ball_escape(space, to, ball_radius_m);
  if (!begin || !end) return {};
  const auto center_W = [&](const SignedPose& pose) {
    return space.center_W(motion::unsigned_pose(pose));
  };
  const CellOptions options = options_for_body(radius_m, ball_radius_m, max_cells);
  CellResult found = cell_way(space, center_W(*begin), center_W(*end), options, deadline);
  if (found.way_W.empty()) return found;
  found.way_W.insert(found.way_W.begin(), center_W(from));
  found.way_W.push_back(center_W(to));
  return found;
}

}  // namespace camway::correction
