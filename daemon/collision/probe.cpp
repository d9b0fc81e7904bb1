// SPDX-License-Identifier: MIT
#include "daemon/collision/probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/collision/crossing.h"
#include "daemon/geometry/rounding.h"
#include "daemon/geometry/triangle_distance.h"
#include "daemon/geometry/triangle_intersection.h"
#include "daemon/geometry/winding.h"
#include "daemon/scene/field/clearance_field.h"
#include "daemon/scene/index/swept_search.h"
#include "daemon/scene/voxels/voxel_map.h"

namespace camway::collision {

namespace {

using geometry::Box;
using geometry::Triangle;
using geometry::Vec3;

// A triangle large enough to prove a collision is nearly always among the first.
constexpr int kMaxCrossingsTried = 16;
// The same for pairs of a triangle of a body of many, which are small.
constexpr int kMaxPairsTried = 64;

Vec3 to_world(const motion::Stretch& stretch, const Vec3& point_C) {
  return stretch.R_WC * point_C + stretch.eye_W;
}

Box bounds_of(std::span<const Triangle> triangles) {
  Box box;
  for (const Triangle& triangle : triangles) box.extend(geometry::bounds(triangle));
  return box;
}

}  // namespace

Probe::Probe(const Obstacles& obstacles, const motion::Body& body, double clearance_m)
    : obstacles_(obstacles),
      body_(body),
      has_bounds_(obstacles.bounds.any()),
      required_distance_m_((body.ball_radius_m() + clearance_m + obstacles.surface_error_m) *
                           kRoundUp),
      radius_m_(body.radius_m()),
      center_radius_m_(body.center_radius_m() * kRoundUp) {
  if (body.tree() != nullptr) {
    tree_.emplace(obstacles, body);
  } else {
    placed_.resize(body.triangles_C().size());
    ends_.resize(2 * placed_.size());
  }
}

void Probe::place(const motion::Stretch& stretch) {
  if (tree_) return tree_->place(stretch);
  const std::span<const Triangle> triangles_C = body_.triangles_C();
  for (std::size_t i = 0; i < triangles_C.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) placed_[i][k] = to_world(stretch, triangles_C[i][k]);
  }
}

Box Probe::box_W() const { return tree_ ? tree_->bounds() : bounds_of(placed_); }

Box Probe::vertex_box() const { return tree_ ? tree_->vertex_box() : bounds_of(placed_); }

Vec3 Probe::vertex_W(std::size_t vertex) const {
  const std::size_t part = vertex / 3;
  return tree_ ? tree_->triangle(static_cast<std::uint32_t>(part))[vertex % 3]
               : placed_[part][vertex % 3];
}

double Probe::field_distance_m(const motion::Stretch& stretch) const {
  if (obstacles_.field == nullptr) return 0.0;
  const Vec3 center_W = to_world(stretch, body_.center_C());
  const double clearance_m = obstacles_.field->clearance_at_least_m(center_W);
  if (!(clearance_m > 0.0)) return 0.0;
  // The centre may be far from all faces, but inside of a solid.
  if (obstacles_.solids != nullptr && obstacles_.solids->hold(center_W)) return 0.0;
  return clearance_m - center_radius_m_ * kRoundUp;
}

void Probe::move(const motion::Stretch& stretch, Way way) {
  if (tree_) return tree_->move(stretch, way == Way::kBackwards);
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
}

// The bounds of `stretch.h` are linear in the radius but for their rounding.
scene::RadialBound Probe::radial(double at_eye_m, double at_radius_m) const {
  const double per_m = std::max(0.0, at_radius_m - at_eye_m) / radius_m_ * kRoundUp;
  return {(at_eye_m + (kRoundUp - 1.0) * at_radius_m) * kRoundUp, per_m};
}

std::optional<scene::SweptResult> Probe::swept(const motion::Stretch& stretch, double keep_m,
                                               double& rounding_m) {
  const double bend_m = this->bend_m(stretch);
  const double reach_m = this->reach_m(stretch);
  const double error_m = tree_ ? tree_->error_m() : obstacles_.index.nearest_error_m(ends_);
  rounding_m += error_m;
  keep_m = (keep_m + error_m + required_distance_m_) * kRoundUp;
  // If the motion is too large or not a number, nothing is known.
  if (!(bend_m + reach_m + keep_m < geometry::kLargestCoordinate_m)) return std::nullopt;
  if (!tree_)
    return obstacles_.index.swept(scene::SweptBody{placed_, ends_, bend_m, reach_m, keep_m});
  const double slack_m = body_.slack_m();
  return tree_->swept({radial((stretch.bend_m(0.0) + slack_m) * kRoundUp, bend_m),
                       radial((stretch.reach_m(0.0) + slack_m) * kRoundUp, reach_m), keep_m});
}

ProbeResult Probe::check(const motion::Stretch& stretch, double margin_m, Way way) {
  ProbeResult result = check_scene(stretch, margin_m, way);
  if (has_bounds_) check_bounds(stretch, margin_m, way, result);
  return result;
}

bool Probe::is_free(const motion::Pose& pose, double margin_m) {
  const motion::Stretch standing = motion::standing_at(pose);
  if (stopped_by_ && !tree_) {
    move(standing, Way::kForwards);
    if (is_surely_near(*stopped_by_, margin_m)) return false;
  }
  return check(standing, margin_m).free;
}

// The search of `check` would find the same: no bound excludes a triangle whose distance is less
// than what is required by more than its error, and no slab about a body that stands still is wider
// than that distance. A distance of exactly 0 is decided by exact predicates.
bool Probe::is_surely_near(std::uint32_t obstacle, double margin_m) {
  const Triangle other = obstacles_.index.triangle(obstacle);
  if (touches(other)) return true;
  const double near_m =
      margin_m + required_distance_m_ - 2.0 * obstacles_.index.nearest_error_m(ends_);
  return near_m > 0.0 && std::ranges::any_of(placed_, [&](const Triangle& part) {
           return geometry::triangle_distance(part, other, near_m) < near_m;
         });
}

ProbeResult Probe::check_scene(const motion::Stretch& stretch, double margin_m, Way way) {
  ProbeResult result;
  result.reach_m = reach_m(stretch);
  result.rounding_m = rounding_m(stretch);
  // The distance of the ball about the triangles: if it is free, no solid of the body holds a part
  // of the scene, and no solid of the scene a part of the body.
  const double field_m = field_distance_m(stretch);
  if (field_m > (result.reach_m + margin_m + required_distance_m_) * kRoundUp) {
    result.free = true;
    result.is_measured = false;
    result.gap_m = field_m - required_distance_m_;
    result.step_scale = result.gap_m / result.reach_m;
    return result;
  }
  move(stretch, way);
  const std::optional<scene::SweptResult> swept = this->swept(stretch, margin_m, result.rounding_m);
  if (!swept) return result;
  if (!swept->is_clear && swept->nearest) stopped_by_ = swept->nearest->triangle;
  result.contains = swept->is_clear && (holds_scene(stretch) || is_in_solid());
  result.free = swept->is_clear && !result.contains;
  result.is_measured = swept->nearest.has_value() || !result.free;
  result.step_scale = swept->step_scale;
  // Inside of a solid the gap stays 0, however far the surface is.
  if (result.contains) return result;
  result.gap_m = swept->nearest ? swept->nearest->distance_m - required_distance_m_ : margin_m;
  return result;
}

double Probe::ball_depth_m(const motion::Stretch& stretch) const {
  const double depth_m = obstacles_.bounds.depth_m(to_world(stretch, body_.center_C()));
  return depth_m - center_radius_m_ * kRoundUp;
}

Depths Probe::least_depths() const {
  if (tree_) return tree_->least_depths();
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
  move(stretch, way);
  const double bend_m = this->bend_m(stretch);
  const Depths depth = least_depths();
  // A reach that is not a number fails both conditions.
  const bool is_inside = result.reach_m < std::numeric_limits<double>::infinity() &&
                         (depth.middle_m > (result.reach_m + keep_m) * kRoundUp ||
                          std::min(depth.first_m, depth.last_m) > (bend_m + keep_m) * kRoundUp);
  const bool is_bent = bend_m > scene::kStraightWay * result.reach_m;
  const double change_m = depth.last_m - depth.first_m;
  const double room_m = (is_inside ? depth.last_m : depth.first_m) - keep_m;
  const double step_scale =
      !is_inside && is_bent ? 0.5 : scene::way_ahead(room_m, change_m, bend_m);
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

std::optional<VertexAtSide> Probe::least_deep_vertex() const {
  if (!has_bounds_) return std::nullopt;
  if (tree_) return tree_->least_deep_vertex();
  VertexAtSide nearest{0, 0, std::numeric_limits<double>::infinity()};
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
  if (result.free || result.contains || !(result.gap_m + required_distance_m_ > 0.0)) return;
  place(stretch);
  // If no triangle is nearer, the gap found before holds.
  const std::optional<scene::Nearest> nearest =
      nearest_in_scene(result.gap_m + required_distance_m_, share);
  if (nearest) result.gap_m = nearest->distance_m - required_distance_m_;
}

std::optional<scene::Nearest> Probe::nearest_in_scene(double cutoff_m, double share) {
  if (tree_) return tree_->near(cutoff_m, share);
  return obstacles_.index.near(placed_, cutoff_m, /*certain_m=*/0.0, share);
}

ProbeResult Probe::check_refined(const motion::Stretch& stretch, double margin_m, double share) {
  ProbeResult seen = check(stretch, margin_m);
  refine(stretch, seen, share);
  return seen;
}

bool Probe::is_in_body(const motion::Stretch& stretch, const Vec3& point_W) const {
  const Vec3 point_C = stretch.R_WC.transpose() * (point_W - stretch.eye_W);
  if (body_.is_solid_mesh()) {
    // A point on a triangle counts as inside.
    return geometry::winding_number(point_C, body_.triangles_C(), *body_.tree()) != 0;
  }
  return std::ranges::any_of(body_.solids_C(),
                             [&](const motion::Solid& solid) { return solid.holds(point_C); });
}

bool Probe::holds_scene(const motion::Stretch& stretch) {
  if (!body_.is_solid()) return false;
  // The surface touches no triangle, so one vertex represents its triangle, and rounding cannot
  // move it across the surface.
  if (body_.is_solid_mesh()) {
    return obstacles_.index.has_inside(
        tree_->body(), [&](const Vec3& point_W) { return is_in_body(stretch, point_W); });
  }
  return !obstacles_.index.for_each_touching(box_W(), [&](std::uint32_t index) {
    return !is_in_body(stretch, obstacles_.index.triangle(index)[0]);
  });
}

std::optional<double> Probe::depth_in_body_m(const motion::Stretch& stretch, const Vec3& point_W) {
  if (body_.is_solid_mesh()) {
    if (!is_in_body(stretch, point_W)) return std::nullopt;
    return tree_->nearest_part(point_W).distance_m;
  }
  const Vec3 point_C = stretch.R_WC.transpose() * (point_W - stretch.eye_W);
  double deepest_m = 0.0;
  for (const motion::Solid& solid : body_.solids_C()) {
    double depth_m = std::numeric_limits<double>::infinity();
    for (const geometry::HalfSpace& face : solid.faces_C)
      depth_m = std::min(depth_m, face.offset_m - face.normal.dot(point_C));
    deepest_m = std::max(deepest_m, depth_m);
  }
  if (!(deepest_m > 0.0)) return std::nullopt;
  return deepest_m;
}

std::uint32_t Probe::nearest_part(const Vec3& point_W) {
  if (tree_) return tree_->nearest_part(point_W).triangle;
  std::uint32_t nearest = 0;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::uint32_t part = 0; part < placed_.size(); ++part) {
    const double distance_m =
        geometry::triangle_distance(placed_[part], {point_W, point_W, point_W});
    if (distance_m >= least_m) continue;
    least_m = distance_m;
    nearest = part;
  }
  return nearest;
}

bool Probe::is_in_solid() const {
  if (obstacles_.solids == nullptr) return false;
  // A connected part of the body that touches no face is inside with all of its points or with
  // none.
  return std::ranges::any_of(body_.connected_parts(), [&](std::uint32_t part) {
    return obstacles_.solids->hold(vertex_W(3 * std::size_t{part}));
  });
}

std::optional<std::uint32_t> Probe::touched_in_the_middle(const motion::Stretch& stretch,
                                                          std::uint32_t guess) {
  place(stretch);
  if (const std::optional<VertexAtSide> vertex = least_deep_vertex();
      vertex && vertex->gap_m <= 0.0)
    return Obstacles::number_of_side(vertex->side);
  if (guess < obstacles_.index.size() && touches(obstacles_.index.triangle(guess))) return guess;
  // `any_within` means "nearer than"; the next double makes it "not farther than".
  const double further_m =
      std::nextafter(required_distance_m_, std::numeric_limits<double>::infinity());
  const std::optional<scene::Nearest> found =
      tree_ ? tree_->any_within(further_m) : obstacles_.index.any_within(placed_, further_m);
  if (!found) return std::nullopt;
  return found->triangle;
}

bool Probe::touches(const Triangle& obstacle) {
  if (tree_) return tree_->touches(obstacle);
  return std::ranges::any_of(
      placed_, [&](const Triangle& part) { return geometry::triangles_touch(part, obstacle); });
}

bool Probe::surely_collides_with(std::uint32_t obstacle, const motion::Stretch& stretch) {
  place(stretch);
  const double moved_m = reach_m(stretch);
  if (Obstacles::is_side(obstacle)) return surely_leaves(moved_m);
  if (!may_surely_meet(moved_m)) return false;
  bool is_proved = false;
  int tried = 0;
  for_each_pair_with(obstacle, required_distance_m_,
                     [&](std::uint32_t, const Triangle& part, const Triangle& other) {
                       is_proved = surely_meets(part, other, moved_m);
                       return !is_proved && !(tree_ && ++tried == kMaxPairsTried);
                     });
  return is_proved;
}

// Whether one vertex stays beyond one side.
bool Probe::surely_leaves(double moved_m) const {
  const std::optional<VertexAtSide> vertex = least_deep_vertex();
  // A depth of about the ball's radius has about the rounding of that radius.
  const double rounding_m = (kRoundUp - 1.0) * body_.ball_radius_m();
  return vertex && -vertex->gap_m > (moved_m + rounding_m) * kRoundUp;
}

std::optional<std::uint32_t> Probe::surely_hit(const motion::Stretch& stretch) {
  place(stretch);
  const double least_m = reach_m(stretch);
  if (surely_leaves(least_m)) return Obstacles::number_of_side(least_deep_vertex()->side);
  if (!may_surely_meet(least_m)) return std::nullopt;
  return tree_ ? surely_hit_by_tree(least_m) : surely_hit_by_few(least_m);
}

std::optional<std::uint32_t> Probe::surely_hit_by_few(double moved_m) {
  std::optional<std::uint32_t> hit;
  int tried = 0;
  obstacles_.index.for_each_touching(bounds_of(placed_), [&](std::uint32_t index) {
    const Triangle obstacle = obstacles_.index.triangle(index);
    const bool is_met = std::ranges::any_of(
        placed_, [&](const Triangle& part) { return surely_meets(part, obstacle, moved_m); });
    if (is_met) hit = index;
    return !hit && ++tried < kMaxCrossingsTried;
  });
  return hit;
}

std::optional<std::uint32_t> Probe::surely_hit_by_tree(double moved_m) {
  std::optional<std::uint32_t> hit;
  int tried = 0;
  for_each_pair(required_distance_m_, [&](std::uint32_t, const Triangle& part, std::uint32_t index,
                                          const Triangle& obstacle) {
    if (surely_meets(part, obstacle, moved_m)) hit = index;
    return !hit && ++tried < kMaxPairsTried;
  });
  return hit;
}

// An edge crosses a triangle with a margin no longer than the edge, and than an edge of the
// triangle: one of the two belongs to the body.
bool Probe::may_surely_meet(double moved_m) const {
  return !tree_ || required_distance_m_ > moved_m || body_.longest_edge_m() > moved_m;
}

double Probe::reach_m(const motion::Stretch& stretch) const {
  return (stretch.reach_m(radius_m_) + body_.slack_m()) * kRoundUp;
}

double Probe::rounding_m(const motion::Stretch& stretch) const {
  return (stretch.rounding_m(radius_m_) + body_.slack_m()) * kRoundUp;
}

bool Probe::surely_meets(const Triangle& part, const Triangle& obstacle, double moved_m) const {
  if (required_distance_m_ > moved_m) {
    const double far_m = geometry::triangle_distance(part, obstacle) +
                         geometry::triangle_distance_error_m(part, obstacle);
    if ((far_m + moved_m) * kRoundUp < required_distance_m_) return true;
  }
  return crossing_margin_m(part, obstacle, moved_m) > moved_m;
}

}  // namespace camway::collision
