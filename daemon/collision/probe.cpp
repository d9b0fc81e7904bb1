// SPDX-License-Identifier: MIT
#include "daemon/collision/probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/collision/crossing.h"
#include "daemon/geometry/rounding.h"
#include "daemon/geometry/triangle_distance.h"
#include "daemon/geometry/triangle_intersection.h"
#include "daemon/scene/field/clearance_field.h"
#include "daemon/scene/index/swept_search.h"
#include "daemon/scene/voxels/voxel_map.h"

namespace camway::collision {

namespace {

using geometry::Box;
using geometry::Triangle;
using geometry::Vec3;

// Upper bound of the rounding of a sum of a few positive numbers, half an epsilon each.
constexpr double kRoundUp = 1.0 + 4.0 * std::numeric_limits<double>::epsilon();

// A triangle large enough to prove a collision is nearly always among the first.
constexpr int kMaxCrossingsTried = 16;

Vec3 to_world(const motion::Stretch& stretch, const Vec3& point_C) {
  return stretch.R_WC * point_C + stretch.eye_W;
}

Box bounds_of(std::span<const Triangle> triangles) {
  Box box;
  for (const Triangle& triangle : triangles) box.extend(geometry::bounds(triangle));
  return box;
}

bool is_inside(const motion::Solid& solid, const Vec3& point_C) {
  return std::ranges::all_of(solid.faces_C, [&](const geometry::HalfSpace& face) {
    return face.normal.dot(point_C) <= face.offset_m;
  });
}

}  // namespace

Probe::Probe(const Obstacles& obstacles, const motion::Body& body, double clearance_m)
    : obstacles_(obstacles),
      body_(body),
      has_bounds_(obstacles.bounds.any()),
      keep_m_((body.ball_radius_m() + clearance_m) * kRoundUp),
      radius_m_(body.radius_m()),
      center_C_(bounds_of(body.triangles_C()).center()),
      placed_(body.triangles_C().size()),
      ends_(2 * placed_.size()) {
  for (const Triangle& triangle : body.triangles_C()) {
    for (const Vec3& vertex : triangle) {
      center_radius_m_ = std::max(center_radius_m_, (vertex - center_C_).norm() * kRoundUp);
    }
  }
}

std::span<const Triangle> Probe::place(const motion::Stretch& stretch) {
  const std::span<const Triangle> triangles_C = body_.triangles_C();
  for (std::size_t i = 0; i < triangles_C.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) placed_[i][k] = to_world(stretch, triangles_C[i][k]);
  }
  return placed_;
}

double Probe::field_distance_m(const motion::Stretch& stretch) const {
  if (obstacles_.field == nullptr) return 0.0;
  const Vec3 center_W = to_world(stretch, center_C_);
  const double clearance_m = obstacles_.field->clearance_at_least_m(center_W);
  if (!(clearance_m > 0.0)) return 0.0;
  // The centre may be far from all faces, but inside of a solid.
  if (obstacles_.solids != nullptr && obstacles_.solids->hold(center_W)) return 0.0;
  return clearance_m - center_radius_m_ * kRoundUp;
}

scene::SweptBody Probe::move(const motion::Stretch& stretch, Way way) {
  const std::span<const Triangle> triangles_C = body_.triangles_C();
  const std::size_t begin = way == Way::kForwards ? 0 : 1;
  for (std::size_t i = 0; i < triangles_C.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 arm_W = stretch.R_WC * triangles_C[i][k];
      const Vec3 step_W = stretch.eye_step_W + stretch.turn_step_W.cross(arm_W);
      placed_[i][k] = arm_W + stretch.eye_W;
      ends_[2 * i + begin][k] = placed_[i][k] - step_W;
      ends_[2 * i + 1 - begin][k] = placed_[i][k] + step_W;
    }
  }
  return {placed_, ends_, (stretch.bend_m(radius_m_) + body_.slack_m()) * kRoundUp,
          reach_m(stretch), 0.0};
}

ProbeResult Probe::check(const motion::Stretch& stretch, double margin_m, Way way) {
  ProbeResult result = check_scene(stretch, margin_m, way);
  if (has_bounds_) check_bounds(stretch, margin_m, way, result);
  return result;
}

ProbeResult Probe::check_scene(const motion::Stretch& stretch, double margin_m, Way way) {
  ProbeResult result;
  result.reach_m = reach_m(stretch);
  result.rounding_m = rounding_m(stretch);
  // The distance of the ball about the triangles: if it is free, no solid of the body holds a part
  // of the scene, and no solid of the scene a part of the body.
  const double field_m = field_distance_m(stretch);
  if (field_m > (result.reach_m + margin_m + keep_m_) * kRoundUp) {
    result.free = true;
    result.is_measured = false;
    result.gap_m = field_m - keep_m_;
    result.step_scale = result.gap_m / result.reach_m;
    return result;
  }
  scene::SweptBody body = move(stretch, way);
  const double error_m = obstacles_.index.nearest_error_m(body.ends);
  result.rounding_m += error_m;
  body.keep_m = (margin_m + error_m + keep_m_) * kRoundUp;
  // If the motion is too large or not a number, nothing is known.
  if (!(body.bend_m + body.reach_m + body.keep_m < geometry::kLargestCoordinate_m)) return result;
  const scene::SweptResult swept = obstacles_.index.swept(body);
  result.contains = swept.is_clear && (holds_scene(stretch) || is_in_solid());
  result.free = swept.is_clear && !result.contains;
  result.is_measured = swept.nearest.has_value() || !result.free;
  result.step_scale = swept.step_scale;
  // Inside of a solid the gap stays 0, however far the surface is.
  if (result.contains) return result;
  result.gap_m = swept.nearest ? swept.nearest->distance_m - keep_m_ : margin_m;
  return result;
}

double Probe::ball_depth_m(const motion::Stretch& stretch) const {
  const double depth_m = obstacles_.bounds.depth_m(to_world(stretch, center_C_));
  return depth_m - center_radius_m_ * kRoundUp;
}

Probe::Depths Probe::least_depths() const {
  Depths least;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      least.middle_m = std::min(least.middle_m, obstacles_.bounds.depth_m(placed_[i][k]));
      least.first_m = std::min(least.first_m, obstacles_.bounds.depth_m(ends_[2 * i][k]));
      least.last_m = std::min(least.last_m, obstacles_.bounds.depth_m(ends_[2 * i + 1][k]));
    }
  }
  return least;
}

void Probe::check_bounds(const motion::Stretch& stretch, double margin_m, Way way,
                         ProbeResult& result) {
  const double ball_m = body_.ball_radius_m();
  const double keep_m = (margin_m + ball_m) * kRoundUp;
  const double all_inside_m = ball_depth_m(stretch);
  if (all_inside_m > (result.reach_m + keep_m) * kRoundUp) {
    if (result.free)
      result.step_scale = std::min(result.step_scale, (all_inside_m - keep_m) / result.reach_m);
    if (!result.is_measured) result.gap_m = std::min(result.gap_m, all_inside_m - ball_m);
    return;
  }
  const scene::SweptBody body = move(stretch, way);
  const Depths depth = least_depths();
  // A reach that is not a number fails both conditions.
  const bool is_inside =
      result.reach_m < std::numeric_limits<double>::infinity() &&
      (depth.middle_m > (result.reach_m + keep_m) * kRoundUp ||
       std::min(depth.first_m, depth.last_m) > (body.bend_m + keep_m) * kRoundUp);
  const bool is_bent = body.bend_m > scene::kStraightWay * result.reach_m;
  const double change_m = depth.last_m - depth.first_m;
  const double room_m = (is_inside ? depth.last_m : depth.first_m) - keep_m;
  const double step_scale =
      !is_inside && is_bent ? 0.5 : scene::way_ahead(room_m, change_m, body.bend_m);
  if (result.free || !is_inside) {
    result.step_scale =
        result.free != is_inside ? step_scale : std::min(result.step_scale, step_scale);
  }
  result.contains = result.contains || surely_leaves(result.reach_m);
  const double gap_m = depth.middle_m - ball_m;
  // Where no obstacle was near, what is left of the scene's gap is a lower bound, often 0.
  const bool is_alone = !is_inside && !result.is_measured;
  result.gap_m = is_alone ? gap_m : std::min(result.gap_m, gap_m);
  result.is_measured = result.is_measured || !is_inside;
  result.free = result.free && is_inside;
}

std::optional<Probe::Edge> Probe::nearest_edge() const {
  if (!has_bounds_) return std::nullopt;
  Edge nearest{0, 0, std::numeric_limits<double>::infinity()};
  for (std::size_t side = 0; side < geometry::Bounds::kSides; ++side) {
    for (std::size_t vertex = 0; vertex < 3 * placed_.size(); ++vertex) {
      const Vec3& vertex_W = placed_[vertex / 3][vertex % 3];
      const double gap_m = obstacles_.bounds.depth_m(side, vertex_W) - body_.ball_radius_m();
      if (gap_m < nearest.gap_m) nearest = {side, vertex, gap_m};
    }
  }
  return nearest;
}

void Probe::refine(const motion::Stretch& stretch, ProbeResult& result, double share) {
  if (result.free || result.contains || !(result.gap_m + keep_m_ > 0.0)) return;
  // If no triangle is nearer, the gap found before holds.
  const std::optional<scene::Nearest> nearest =
      obstacles_.index.near(place(stretch), result.gap_m + keep_m_, /*certain_m=*/0.0, share);
  if (nearest) result.gap_m = nearest->distance_m - keep_m_;
}

ProbeResult Probe::check_refined(const motion::Stretch& stretch, double margin_m, double share) {
  ProbeResult seen = check(stretch, margin_m);
  refine(stretch, seen, share);
  return seen;
}

bool Probe::holds_scene(const motion::Stretch& stretch) {
  if (body_.solids_C().empty()) return false;
  // The surface touches no triangle, so one vertex represents its triangle, and rounding cannot
  // move it across the surface.
  return !obstacles_.index.for_each_touching(bounds_of(placed_), [&](std::uint32_t index) {
    const Vec3 point_W = obstacles_.index.triangle(index)[0];
    const Vec3 point_C = stretch.R_WC.transpose() * (point_W - stretch.eye_W);
    return std::ranges::none_of(
        body_.solids_C(), [&](const motion::Solid& solid) { return is_inside(solid, point_C); });
  });
}

bool Probe::is_in_solid() const {
  if (obstacles_.solids == nullptr) return false;
  return std::ranges::any_of(
      placed_, [&](const Triangle& part) { return obstacles_.solids->hold(part[0]); });
}

std::optional<std::uint32_t> Probe::touched_in_the_middle(const motion::Stretch& stretch,
                                                          std::uint32_t guess) {
  const std::span<const Triangle> placed = place(stretch);
  if (const std::optional<Edge> edge = nearest_edge(); edge && edge->gap_m <= 0.0)
    return Obstacles::number_of_side(edge->side);
  if (guess < obstacles_.index.size()) {
    const Triangle guessed = obstacles_.index.triangle(guess);
    const bool is_right = std::ranges::any_of(
        placed, [&](const Triangle& part) { return geometry::triangles_touch(part, guessed); });
    if (is_right) return guess;
  }
  // `any_within` means "nearer than"; the next double makes it "not farther than".
  const double further_m = std::nextafter(keep_m_, std::numeric_limits<double>::infinity());
  const std::optional<scene::Nearest> found = obstacles_.index.any_within(placed, further_m);
  if (!found) return std::nullopt;
  return found->triangle;
}

bool Probe::surely_collides_with(std::uint32_t obstacle, const motion::Stretch& stretch) {
  place(stretch);
  if (!Obstacles::is_side(obstacle))
    return surely_meets(obstacles_.index.triangle(obstacle), reach_m(stretch));
  return surely_leaves(reach_m(stretch));
}

// Whether one vertex stays beyond one side.
bool Probe::surely_leaves(double moved_m) const {
  const std::optional<Edge> edge = nearest_edge();
  // A depth of about the ball's radius has about the rounding of that radius.
  const double rounding_m = (kRoundUp - 1.0) * body_.ball_radius_m();
  return edge && -edge->gap_m > (moved_m + rounding_m) * kRoundUp;
}

std::optional<std::uint32_t> Probe::surely_hit(const motion::Stretch& stretch) {
  place(stretch);
  const double least_m = reach_m(stretch);
  if (surely_leaves(least_m)) return Obstacles::number_of_side(nearest_edge()->side);
  std::optional<std::uint32_t> hit;
  int tried = 0;
  obstacles_.index.for_each_touching(bounds_of(placed_), [&](std::uint32_t index) {
    if (surely_meets(obstacles_.index.triangle(index), least_m)) hit = index;
    return !hit && ++tried < kMaxCrossingsTried;
  });
  return hit;
}

double Probe::reach_m(const motion::Stretch& stretch) const {
  return (stretch.reach_m(radius_m_) + body_.slack_m()) * kRoundUp;
}

double Probe::rounding_m(const motion::Stretch& stretch) const {
  return (stretch.rounding_m(radius_m_) + body_.slack_m()) * kRoundUp;
}

bool Probe::surely_meets(const Triangle& obstacle, double moved_m) const {
  return std::ranges::any_of(placed_, [&](const Triangle& part) {
    if (keep_m_ > moved_m) {
      const double far_m = geometry::triangle_distance(part, obstacle) +
                           geometry::triangle_distance_error_m(part, obstacle);
      if ((far_m + moved_m) * kRoundUp < keep_m_) return true;
    }
    return crossing_margin_m(part, obstacle, moved_m) > moved_m;
  });
}

}  // namespace camway::collision
