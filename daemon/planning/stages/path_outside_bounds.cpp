// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/path_outside_bounds.h"

#include <fmt/format.h>

#include "daemon/collision/probe.h"

namespace camway::planning {

namespace {

using geometry::Bounds;
using geometry::Vec3;

constexpr int kSamplesASegment = 16;  // enough for a message

struct Excess {
  std::size_t side = 0;
  double by_m = 0.0;
};

/// Returns where samples of `path` are furthest beyond the bounds.
Excess largest_excess(const motion::Path& path, const motion::Body& body,
                      const collision::Obstacles& obstacles, const Bounds& bounds) {
  Excess largest;
  collision::Probe probe(obstacles, body, /*clearance_m=*/0.0);
  for (const motion::Segment& segment : path.segments()) {
    for (int i = 0; i <= kSamplesASegment; ++i) {
      const double u = static_cast<double>(i) / kSamplesASegment;
      probe.place(motion::standing_at(path.pose(motion::segment_time_s(segment, u))));
      const geometry::Box box = probe.vertex_box();
      for (std::size_t side = 0; side < Bounds::kSides; ++side) {
        const Vec3& outermost_W = side < 3 ? box.min() : box.max();
        const double by_m = body.ball_radius_m() - bounds.depth_m(side, outermost_W);
        if (by_m > largest.by_m) largest = {side, by_m};
      }
    }
  }
  return largest;
}

}  // namespace

bool may_have_path_outside_bounds(const PlanRequest& request, const PlanResult& result) {
  if (request.options.method != Method::kLadder || request.options.max_inserted_keyframes == 0)
    return false;
  // A way within the bounds was found, and refused for its keyframes.
  if (result.needs_more_keyframes) return false;
  const bool is_open = result.status == Status::kPartial || result.status == Status::kTimeout;
  return result.bounds.any() && is_open && !result.remaining_collisions.empty();
}

void add_path_outside_bounds(const PlanResult& unbounded, const collision::Obstacles& obstacles,
                             const PlanRequest& request, PlanResult& result) {
  result.timing.correct_ms += unbounded.timing.total_ms;
  result.timing.total_ms += unbounded.timing.total_ms;
  if (!unbounded.certificate.certified) return;
  const auto body = motion::Body::make(body_shape(request, unbounded.near_scale));
  if (!body) return;
  const Excess excess = largest_excess(unbounded.path, *body, obstacles, result.bounds);
  result.message += fmt::format("; a way was found only beyond the bounds, by up to {:.2g} m at {}",
                                excess.by_m, Bounds::kSideNames[excess.side]);
}

}  // namespace camway::planning
