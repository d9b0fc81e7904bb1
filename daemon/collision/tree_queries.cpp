// SPDX-License-Identifier: MIT
#include "daemon/collision/tree_queries.h"

#include <cmath>

#include "daemon/geometry/triangle_distance.h"
#include "daemon/geometry/triangle_intersection.h"

namespace camway::collision {

using geometry::Triangle;
using geometry::Vec3;
using Node = geometry::TriangleTree::Node;

TreeQueries::TreeQueries(const Obstacles& obstacles, const motion::Body& body)
    : obstacles_(obstacles), motion_body_(body), body_(*body.tree(), body.triangles_C()) {}

void TreeQueries::place(const motion::Stretch& stretch) {
  body_.place({stretch.R_WC, stretch.eye_W});
}

void TreeQueries::move(const motion::Stretch& stretch, bool is_backwards) {
  const double sense = is_backwards ? -1.0 : 1.0;
  body_.place(
      {stretch.R_WC, stretch.eye_W, sense * stretch.eye_step_W, sense * stretch.turn_step_W});
}

double TreeQueries::error_m() const {
  return geometry::triangle_distance_error_m(body_.scale_m(obstacles_.index.bounds()));
}

scene::SweptResult TreeQueries::swept(const scene::TreeMargins& margins) {
  if (obstacles_.index.size() == 0)
    return {true, std::nullopt, std::numeric_limits<double>::infinity()};
  if (!body_.is_usable()) return {false, scene::Nearest{0.0, 0}, 0.0};
  scene::TreeSwept search(body_, obstacles_.index.bounds(), margins);
  run(search);
  return search.result();
}

std::optional<scene::Nearest> TreeQueries::near(double cutoff_m, double share) {
  if (obstacles_.index.size() == 0) return std::nullopt;
  if (!body_.is_usable() || std::isnan(cutoff_m)) return scene::Nearest{0.0, 0};
  scene::TreeDistance search(body_, obstacles_.index.bounds(), cutoff_m, scene::DistanceGoal::kNear,
                             /*certain_m=*/0.0, share);
  run(search);
  return search.result();
}

std::optional<scene::Nearest> TreeQueries::any_within(double distance_m) {
  if (obstacles_.index.size() == 0) return std::nullopt;
  if (!body_.is_usable() || std::isnan(distance_m)) return scene::Nearest{0.0, 0};
  scene::TreeDistance search(body_, obstacles_.index.bounds(), distance_m,
                             scene::DistanceGoal::kAny);
  obstacles_.index.search(search);
  if (search.pair()) last_pair_ = search.pair();
  return search.result();
}

bool TreeQueries::touches(const Triangle& obstacle) {
  bool found = false;
  for_each_pair_with(0, obstacle, 0.0,
                     [&](std::uint32_t number, std::uint32_t, const Triangle& other) {
                       found = geometry::triangles_touch(triangle(number), other);
                       return !found;
                     });
  return found;
}

scene::Nearest TreeQueries::nearest_part(const Vec3& point_W) {
  const Triangle point = {point_W, point_W, point_W};
  scene::TreeDistance search(body_, geometry::bounds(point),
                             std::numeric_limits<double>::infinity(),
                             scene::DistanceGoal::kNearest);
  search.ask(0, 0, point);
  const std::optional<scene::Nearest> found = search.result();
  return {found ? found->distance_m : 0.0, found ? search.pair()->number : 0};
}

TreeQueries::SideDepth TreeQueries::depth_in(const geometry::Bounds& bounds, std::size_t side,
                                             Instant instant) const {
  const Vec3& eye_W = body_.motion().eye_W;
  const Vec3 inward_C = body_.motion().R_WC.transpose() * geometry::Bounds::inward(side);
  const scene::MovedDirection moved = body_.moved(inward_C);
  double offset_m = bounds.depth_m(side, eye_W) - body_.rounding_m(geometry::Box(eye_W));
  if (instant == Instant::kMiddle) return {bounds, side, instant, inward_C, offset_m};
  const bool is_end = instant == Instant::kEnd;
  offset_m += is_end ? moved.ahead_m : -moved.ahead_m;
  return {bounds, side, instant, is_end ? moved.ahead : moved.behind, offset_m};
}

// Branch and bound. The depths are those of the vertices as placed in doubles.
void TreeQueries::find_least(const SideDepth& depth, VertexAtSide& least) const {
  descend(
      depth, [&] { return least.gap_m; },
      [&](const Node& leaf) {
        find_least_in_leaf(depth, leaf, least);
        return true;
      });
}

void TreeQueries::find_least_in_leaf(const SideDepth& depth, const Node& leaf,
                                     VertexAtSide& least) const {
  for (std::uint32_t i = leaf.begin; i < leaf.end; ++i) {
    const std::uint32_t number = body_.tree().order()[i];
    const Triangle placed = depth.instant == Instant::kMiddle
                                ? body_.middle(number)
                                : body_.ends(number)[depth.instant == Instant::kEnd ? 1 : 0];
    for (std::size_t k = 0; k < 3; ++k) {
      const double depth_m = depth.bounds.depth_m(depth.side, placed[k]);
      if (depth_m < least.gap_m) least = {depth.side, 3 * std::size_t{number} + k, depth_m};
    }
  }
}

VertexAtSide TreeQueries::least_depth(Instant instant) const {
  VertexAtSide least{0, 0, std::numeric_limits<double>::infinity()};
  for (std::size_t side = 0; side < geometry::Bounds::kSides; ++side) {
    if (std::isfinite(obstacles_.bounds.limit_m(side)))
      find_least(depth_in(obstacles_.bounds, side, instant), least);
  }
  return least;
}

Depths TreeQueries::least_depths() const {
  return {least_depth(Instant::kMiddle).gap_m, least_depth(Instant::kBegin).gap_m,
          least_depth(Instant::kEnd).gap_m};
}

VertexAtSide TreeQueries::least_deep_vertex() const {
  VertexAtSide least = least_depth(Instant::kMiddle);
  least.gap_m -= motion_body_.ball_radius_m();
  return least;
}

geometry::Box TreeQueries::vertex_box() const {
  const geometry::Bounds zero{Vec3::Zero(), Vec3::Zero()};
  geometry::Box box;
  for (std::size_t side = 0; side < geometry::Bounds::kSides; ++side) {
    VertexAtSide least{side, 0, std::numeric_limits<double>::infinity()};
    find_least(depth_in(zero, side, Instant::kMiddle), least);
    const auto axis = static_cast<Eigen::Index>(side % 3);
    (side < 3 ? box.min() : box.max())[axis] = side < 3 ? least.gap_m : -least.gap_m;
  }
  return box;
}

}  // namespace camway::collision
