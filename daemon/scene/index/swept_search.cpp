// SPDX-License-Identifier: MIT
#include "daemon/scene/index/swept_search.h"

#include <algorithm>
#include <cmath>

#include "daemon/geometry/triangle_distance.h"

namespace camway::scene {

using geometry::Triangle;
using geometry::TriangleGap;
using geometry::Vec3;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

SweptSearch::SweptSearch(const SweptBody& body, const geometry::Box& ends_box, double error_m)
    : BodySearch(body.ends, 2, ends_box, error_m), body_(body), nearest_{kInfinity, kNone} {
  shrink_to(body.bend_m + body.keep_m);
}

SweptResult SweptSearch::result() const {
  SweptResult result{is_clear_, std::nullopt, ahead_};
  if (nearest_.triangle != kNone) result.nearest = nearest_;
  return result;
}

void SweptSearch::ask_pair(std::size_t part, const Triangle& triangle, std::uint32_t index) {
  const double far_m = body_.reach_m + body_.keep_m;
  const TriangleGap gap = geometry::triangle_gap(body_.middle[part], triangle, far_m);
  if (gap.distance_m > far_m) return;
  if (gap.distance_m < nearest_.distance_m) nearest_ = {gap.distance_m, index};
  const std::span<const Triangle> ends = body_.ends.subspan(2 * part, 2);
  if (gap.distance_m > 0.0 && passed_ < kMostPassed && passes(ends, triangle, gap.direction)) {
    ++passed_;
    return;
  }
  is_clear_ = false;
  stop_before(ends, triangle);
  finish();
}

bool SweptSearch::passes(std::span<const Triangle> ends, const Triangle& triangle,
                         const Vec3& direction) {
  const double first_m = geometry::slab_width_m(ends[0], triangle, direction);
  const double last_m = geometry::slab_width_m(ends[1], triangle, direction);
  if (!(std::min(first_m, last_m) > body_.bend_m + body_.keep_m)) return false;
  ahead_ = std::min(ahead_, way_ahead(last_m - body_.keep_m, last_m - first_m, body_.bend_m));
  return true;
}

void SweptSearch::stop_before(std::span<const Triangle> ends, const Triangle& triangle) {
  ahead_ = 0.5;
  if (body_.bend_m > kStraightWay * body_.reach_m) return;
  const TriangleGap gap = geometry::triangle_gap(ends[0], triangle, kInfinity);
  ahead_ = 0.0;
  if (!(gap.distance_m > 0.0)) return;
  const double last_m = geometry::slab_width_m(ends[1], triangle, gap.direction);
  ahead_ = way_ahead(gap.distance_m - body_.keep_m, last_m - gap.distance_m, body_.bend_m);
}

// All of the motion, from its beginning on, must be clear across one direction, and the part of the
// room that the bend takes grows with the square of the length. So the factor f solves
//     room + min(0, f·change) = f²·bend.
double way_ahead(double room_m, double change_m, double bend_m) {
  if (!(room_m > 0.0)) return 0.0;
  const double closing_m = std::max(0.0, -change_m);
  return 2.0 * room_m / (closing_m + std::sqrt(closing_m * closing_m + 4.0 * bend_m * room_m));
}

}  // namespace camway::scene
