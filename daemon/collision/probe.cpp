// SPDX-License-Identifier: MIT
#include "daemon/collision/probe.h"

#include <algorithm>
#include <limits>

#include "daemon/collision/crossing.h"
#include "daemon/geometry/rounding.h"

namespace camway::collision {

namespace {

using geometry::Box;
using geometry::Triangle;
using geometry::Vec3;

// Sums of a handful of positive numbers, each of which rounds by half of this at most.
constexpr double kRoundUp = 1.0 + 4.0 * std::numeric_limits<double>::epsilon();

// A triangle that is large enough to prove a collision is met among the first or hardly at all.
constexpr int kMaxCrossingsTried = 32;

Vec3 to_world(const motion::Stretch& stretch, const Vec3& point_C) {
  return stretch.R_WC * point_C + stretch.eye_W;
}

Box bounds_of(std::span<const Triangle> triangles) {
  Box box;
  for (const Triangle& triangle : triangles) box.extend(geometry::bounds(triangle));
  return box;
}

bool is_inside(const motion::Solid& solid, const Vec3& point_C) {
  return std::ranges::all_of(solid.faces_C, [&](const motion::HalfSpace& face) {
    return face.normal.dot(point_C) <= face.offset_m;
  });
}

}  // namespace

Probe::Probe(const Obstacles& obstacles, const motion::Body& body, double clearance_m)
    : obstacles_(obstacles),
      body_(body),
      keep_m_((body.ball_radius_m() + clearance_m) * kRoundUp),
      radius_m_(body.radius_m()),
      center_C_(bounds_of(body.triangles_C()).center()),
      placed_(body.triangles_C().size()) {
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
  return obstacles_.field->clearance_at_least_m(to_world(stretch, center_C_)) -
         center_radius_m_ * kRoundUp;
}

Look Probe::look(const motion::Stretch& stretch, double margin_m) {
  Look look;
  look.reach_m = (stretch.reach_m(radius_m_) + body_.slack_m()) * kRoundUp;
  look.rounding_m = (stretch.rounding_m(radius_m_) + body_.slack_m()) * kRoundUp;
  const double moving_m = look.reach_m + margin_m;
  // Of the ball about the triangles: what it holds cannot be inside a solid either.
  const double field_m = field_distance_m(stretch);
  if (field_m > (moving_m + keep_m_) * kRoundUp) {
    look.free = true;
    look.gap_m = field_m - keep_m_;
    return look;
  }
  const std::span<const Triangle> placed = place(stretch);
  const double error_m = obstacles_.index.nearest_error_m(placed);
  look.rounding_m += error_m;
  const double needed_m = (moving_m + error_m + keep_m_) * kRoundUp;
  // Too large or not a number: then nothing is known, and the motion is at fault.
  if (!(needed_m < geometry::kLargestCoordinate_m)) return look;
  const std::optional<scene::Nearest> nearest = obstacles_.index.nearest(placed, needed_m);
  if (nearest) {
    look.gap_m = nearest->distance_m - keep_m_;
    look.triangle = nearest->triangle;
  } else {
    look.free = !holds_scene(stretch);
    look.gap_m = look.free ? needed_m - keep_m_ : 0.0;
  }
  return look;
}

bool Probe::holds_scene(const motion::Stretch& stretch) {
  if (body_.solids_C().empty()) return false;
  // The surface keeps away from all triangles, so one vertex stands for its triangle, and rounding
  // cannot take it across.
  return !obstacles_.index.for_each_touching(bounds_of(placed_), [&](std::uint32_t index) {
    const Vec3 point_W = obstacles_.index.triangle(index)[0];
    const Vec3 point_C = stretch.R_WC.transpose() * (point_W - stretch.eye_W);
    return std::ranges::none_of(
        body_.solids_C(), [&](const motion::Solid& solid) { return is_inside(solid, point_C); });
  });
}

bool Probe::surely_collides(const motion::Stretch& stretch, const Look& seen) {
  const double moving_m = (seen.reach_m + seen.rounding_m) * kRoundUp;
  if (seen.gap_m + moving_m < 0.0) return true;
  if (seen.gap_m > -keep_m_) return false;  // no triangle is touched
  const std::span<const Triangle> placed = place(stretch);
  int tried = 0;
  return !obstacles_.index.for_each_touching(bounds_of(placed), [&](std::uint32_t index) {
    const Triangle obstacle = obstacles_.index.triangle(index);
    const bool surely = std::ranges::any_of(placed, [&](const Triangle& part) {
      return crossing_margin_m(part, obstacle, moving_m) > moving_m;
    });
    return !surely && ++tried < kMaxCrossingsTried;
  }) && tried < kMaxCrossingsTried;
}

}  // namespace camway::collision
