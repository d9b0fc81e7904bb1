// SPDX-License-Identifier: MIT
#include "daemon/scene/index/tree_search.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "daemon/geometry/triangle_distance.h"
#include "daemon/scene/index/swept_search.h"

namespace camway::scene {

using geometry::Triangle;
using geometry::TriangleGap;
using geometry::Vec3;
using Node = geometry::TriangleTree::Node;

namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Shortest direction across which a gap is measured: squares of shorter ones lose digits.
constexpr double kShortestDirection = 0x1p-200;

/// The point of a triangle that is closest to `p`, about: it only chooses a direction. By the
/// regions of vertices, edges and inside (Ericson 2005, "Real-Time Collision Detection", 5.1.5).
Vec3 closest_point(const Triangle& t, const Vec3& p) {
  const Vec3 e = t[1] - t[0];
  const Vec3 f = t[2] - t[0];
  const double e0 = e.dot(p - t[0]);
  const double f0 = f.dot(p - t[0]);
  if (e0 <= 0.0 && f0 <= 0.0) return t[0];
  const double e1 = e.dot(p - t[1]);
  const double f1 = f.dot(p - t[1]);
  if (e1 >= 0.0 && f1 <= e1) return t[1];
  const double e2 = e.dot(p - t[2]);
  const double f2 = f.dot(p - t[2]);
  if (f2 >= 0.0 && e2 <= f2) return t[2];
  const double c = e0 * f1 - e1 * f0;
  if (c <= 0.0 && e0 >= 0.0 && e1 <= 0.0) return t[0] + e0 / (e0 - e1) * e;
  const double b = e2 * f0 - e0 * f2;
  if (b <= 0.0 && f0 >= 0.0 && f2 <= 0.0) return t[0] + f0 / (f0 - f2) * f;
  const double a = e1 * f2 - e2 * f1;
  if (a <= 0.0 && f1 >= e1 && e2 >= f2)
    return t[1] + (f1 - e1) / ((f1 - e1) + (e2 - f2)) * (t[2] - t[1]);
  return t[0] + (b * e + c * f) / (a + b + c);
}

}  // namespace

TreeSearch::TreeSearch(TreeBody& body, const geometry::Box& scene)
    : body_(body),
      rounding_m_(body.rounding_m(scene) +
                  geometry::triangle_distance_error_m(body.scale_m(scene))) {}

void TreeSearch::prepare(const Triangle& triangle) {
  Triangle& t = asked_.triangle_C;
  for (std::size_t k = 0; k < 3; ++k) t[k] = body_.to_body(triangle[k]);
  asked_.box_C = geometry::bounds(t);
  asked_.slab = slab_across((t[1] - t[0]).cross(t[2] - t[0]));
}

void TreeSearch::ask_first(std::uint32_t number, std::uint32_t index, const Triangle& triangle) {
  prepare(triangle);
  double radius_m = 0.0;
  for (const Vec3& vertex : body_.triangle_C(number))
    radius_m = std::max(radius_m, geometry::length_above(vertex));
  ask_pair(number, radius_m, index, triangle);
}

void TreeSearch::ask(std::uint32_t from, std::uint32_t index, const Triangle& triangle) {
  prepare(triangle);
  std::array<Waiting, geometry::TriangleTree::kMaxDepth + 1> waiting;
  std::size_t count = 0;
  waiting[count++] = {squared_gap_m2(body_.node(from)), from};
  while (count > 0 && !is_done_) {
    const Waiting top = waiting[--count];
    const Node& node = body_.node(top.node);
    if (top.squared_m2 > squared_reach_m2(node) || is_separate(node)) continue;
    if (node.is_leaf()) {
      ask_leaf(node, index, triangle);
      continue;
    }
    Waiting near{squared_gap_m2(body_.node(top.node + 1)), top.node + 1};
    Waiting far{squared_gap_m2(body_.node(node.second_child)), node.second_child};
    if (far.squared_m2 < near.squared_m2) std::swap(near, far);
    waiting[count++] = far;
    waiting[count++] = near;
  }
}

void TreeSearch::ask_leaf(const Node& leaf, std::uint32_t index, const Triangle& triangle) {
  for (std::uint32_t i = leaf.begin; i < leaf.end && !is_done_; ++i) {
    const std::uint32_t number = body_.tree().order()[i];
    const Triangle& part = body_.triangle_C(number);
    const auto is_apart = [&](const Slab& slab) {
      return gap_across(slab, part) > limit_.at(leaf.radius_m) + rounding_m_;
    };
    if (is_apart(asked_.slab)) continue;
    if (is_apart(slab_towards((part[0] + part[1] + part[2]) / 3.0))) continue;
    ask_pair(number, leaf.radius_m, index, triangle);
  }
}

double TreeSearch::squared_gap_m2(const Node& node) const {
  const Vec3 half = body_.moved_half(node);
  const Vec3 above = asked_.box_C.min() - (node.center + half);
  const Vec3 below = (node.center - half) - asked_.box_C.max();
  return above.cwiseMax(below).cwiseMax(0.0).squaredNorm();
}

TreeSearch::Slab TreeSearch::slab_across(const Vec3& direction_C) const {
  Slab slab;
  slab.length = direction_C.norm();
  slab.direction = body_.moved(direction_C);
  const Triangle& t = asked_.triangle_C;
  const std::array<double, 3> along = {direction_C.dot(t[0]), direction_C.dot(t[1]),
                                       direction_C.dot(t[2])};
  slab.low = std::min({along[0], along[1], along[2]});
  slab.high = std::max({along[0], along[1], along[2]});
  return slab;
}

TreeSearch::Slab TreeSearch::slab_towards(const Vec3& point_C) const {
  return slab_across(point_C - closest_point(asked_.triangle_C, point_C));
}

double TreeSearch::gap_across(const Slab& slab, const Node& node) {
  if (!(slab.length > kShortestDirection)) return 0.0;
  const MovedDirection& d = slab.direction;
  const double last = d.ahead.dot(node.center) + d.ahead_m;
  const double last_half = d.ahead.cwiseAbs().dot(node.half);
  const double first = d.behind.dot(node.center) - d.ahead_m;
  const double first_half = d.behind.cwiseAbs().dot(node.half);
  const double above = std::min(last - last_half, first - first_half) - slab.high;
  const double below = slab.low - std::max(last + last_half, first + first_half);
  return std::max(above, below) / slab.length;
}

double TreeSearch::gap_across(const Slab& slab, const Triangle& part_C) {
  if (!(slab.length > kShortestDirection)) return 0.0;
  const MovedDirection& d = slab.direction;
  double low = kNoLimit;
  double high = -kNoLimit;
  for (const Vec3& vertex : part_C) {
    const double last = d.ahead.dot(vertex) + d.ahead_m;
    const double first = d.behind.dot(vertex) - d.ahead_m;
    low = std::min({low, last, first});
    high = std::max({high, last, first});
  }
  return std::max(low - slab.high, slab.low - high) / slab.length;
}

bool TreeSearch::is_separate(const Node& node) const {
  const double limit_m = limit_.at(node.radius_m) + rounding_m_;
  return gap_across(asked_.slab, node) > limit_m ||
         gap_across(slab_towards(node.center), node) > limit_m;
}

TreeDistance::TreeDistance(TreeBody& body, const geometry::Box& scene, double cutoff_m,
                           DistanceGoal goal, double certain_m, double share)
    : TreeSearch(body, scene),
      goal_(goal),
      certain_m_(certain_m),
      share_(share),
      limit_m_(cutoff_m),
      best_{cutoff_m, kNone} {
  set_limit({limit_m_, 0.0});
}

std::optional<Nearest> TreeDistance::result() const {
  if (best_.triangle == kNone) return std::nullopt;
  return best_;
}

std::optional<TreeDistance::Pair> TreeDistance::pair() const {
  if (best_.triangle == kNone) return std::nullopt;
  return Pair{number_, best_.triangle};
}

void TreeDistance::ask_pair(std::uint32_t number, double, std::uint32_t index,
                            const Triangle& triangle) {
  const double distance_m = geometry::triangle_distance(body().middle(number), triangle, limit_m_);
  if (!(distance_m < best_.distance_m)) return;
  best_ = {distance_m, index};
  number_ = number;
  limit_m_ = goal_ != DistanceGoal::kNear ? distance_m
             : distance_m < certain_m_    ? share_ * distance_m
                                          : std::max(share_ * distance_m, certain_m_);
  set_limit({limit_m_, 0.0});
  if (goal_ == DistanceGoal::kAny || distance_m == 0.0) finish();
}

TreeSwept::TreeSwept(TreeBody& body, const geometry::Box& scene, const TreeMargins& margins)
    : TreeSearch(body, scene), margins_(margins), nearest_{kNoLimit, kNone} {
  set_limit({margins.bend.at_eye_m + margins.keep_m, margins.bend.per_m});
}

SweptResult TreeSwept::result() const {
  SweptResult result{is_clear_, std::nullopt, ahead_};
  if (nearest_.triangle != kNone) result.nearest = nearest_;
  return result;
}

std::optional<TreeDistance::Pair> TreeSwept::pair() const {
  if (nearest_.triangle == kNone) return std::nullopt;
  return pair_;
}

void TreeSwept::ask_pair(std::uint32_t number, double radius_m, std::uint32_t index,
                         const Triangle& triangle) {
  const double bend_m = margins_.bend.at(radius_m);
  const double reach_m = margins_.reach.at(radius_m);
  const double far_m = reach_m + margins_.keep_m;
  const TriangleGap gap = geometry::triangle_gap(body().middle(number), triangle, far_m);
  if (gap.distance_m > far_m) return;
  if (gap.distance_m < nearest_.distance_m) nearest_ = {gap.distance_m, index};
  pair_ = {number, index};
  if (gap.distance_m > 0.0 && passed_ < kMostPassed &&
      passes(number, triangle, gap.direction, bend_m + margins_.keep_m, bend_m)) {
    ++passed_;
    try_direction(body().motion().R_WC.transpose() * gap.direction);
    return;
  }
  is_clear_ = false;
  stop_before(number, triangle, bend_m, reach_m);
  finish();
}

bool TreeSwept::passes(std::uint32_t number, const Triangle& triangle, const Vec3& direction_W,
                       double limit_m, double bend_m) {
  const std::array<Triangle, 2> ends = body().ends(number);
  const double first_m = geometry::slab_width_m(ends[0], triangle, direction_W);
  const double last_m = geometry::slab_width_m(ends[1], triangle, direction_W);
  if (!(std::min(first_m, last_m) > limit_m)) return false;
  ahead_ = std::min(ahead_, way_ahead(last_m - margins_.keep_m, last_m - first_m, bend_m));
  return true;
}

void TreeSwept::stop_before(std::uint32_t number, const Triangle& triangle, double bend_m,
                            double reach_m) {
  ahead_ = 0.5;
  if (bend_m > kStraightWay * reach_m) return;
  const std::array<Triangle, 2> ends = body().ends(number);
  const TriangleGap gap = geometry::triangle_gap(ends[0], triangle, kNoLimit);
  ahead_ = 0.0;
  if (!(gap.distance_m > 0.0)) return;
  const double last_m = geometry::slab_width_m(ends[1], triangle, gap.direction);
  ahead_ = way_ahead(gap.distance_m - margins_.keep_m, last_m - gap.distance_m, bend_m);
}

}  // namespace camway::scene
