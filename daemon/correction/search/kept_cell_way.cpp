// SPDX-License-Identifier: MIT
#include "daemon/correction/search/kept_cell_way.h"

#include "daemon/correction/search/cell_search.h"

namespace camway::correction {

namespace {

constexpr double kSmallestBodyCell = 0.04;  // in radii of the body; chosen by measurement

}  // namespace

KeptWay kept_cell_way(FreeSpace& space, const motion::SignedPose& from,
                      const motion::SignedPose& to, std::size_t max_cells,
                      const base::Deadline& deadline) {
  const geometry::Quat orientation = geometry::from_wxyz(from.orientation);
  const double radius_m = space.ball_radius_m();
  CellOptions options;
  options.smallest_m = kSmallestBodyCell * radius_m;
  options.max_cells = max_cells;
  options.comfort_m = kSmallestBodyCell * radius_m;
  options.body_gap_m = [&](const geometry::Vec3& center_W, double up_to_m) {
    return space.gap_m(space.pose_around(center_W, orientation), up_to_m);
  };
  options.body_radius_m = radius_m;
  const auto center_W = [&](const motion::SignedPose& pose) {
    return space.center_W(motion::unsigned_pose(pose));
  };
  const CellResult found = cell_way(space, center_W(from), center_W(to), options, deadline);
  KeptWay way{{}, found.cells};
  if (found.way_W.empty()) return way;
  for (const geometry::Vec3& point_W : found.way_W) {
    way.guide.push_back({space.pose_around(point_W, orientation).position, from.orientation});
  }
  way.guide.front() = from;
  way.guide.back() = to;
  return way;
}

}  // namespace camway::correction
