// SPDX-License-Identifier: MIT
#include "daemon/scene/index/tree_body.h"

#include <cmath>

#include "daemon/geometry/rounding.h"

namespace camway::scene {

using geometry::Box;
using geometry::Triangle;
using geometry::Vec3;
using Node = geometry::TriangleTree::Node;

namespace {

/// The largest components of `a × x` for all x with components up to `half`.
Vec3 largest_cross(const Vec3& a, const Vec3& half) {
  const Vec3 s = a.cwiseAbs();
  return {s.y() * half.z() + s.z() * half.y(), s.z() * half.x() + s.x() * half.z(),
          s.x() * half.y() + s.y() * half.x()};
}

}  // namespace

void TreeBody::place(const BodyMotion& motion) {
  motion_ = motion;
  abs_R_ = motion.R_WC.cwiseAbs();
  eye_step_C_ = motion.R_WC.transpose() * motion.eye_step_W;
  turn_step_C_ = motion.R_WC.transpose() * motion.turn_step_W;
  is_moving_ = !motion.eye_step_W.isZero(0.0) || !motion.turn_step_W.isZero(0.0);
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto at = static_cast<std::size_t>(k);
    axes_.origin_m[at] = motion.eye_W[k];
    for (Eigen::Index c = 0; c < 3; ++c)
      axes_.axis[static_cast<std::size_t>(c)][at] = motion.R_WC(c, k);
  }
  placed_.clear();
  placed_.push_back(place_node(0));
}

Triangle TreeBody::middle(std::uint32_t number) const {
  Triangle triangle;
  for (std::size_t k = 0; k < 3; ++k)
    triangle[k] = motion_.R_WC * triangles_C_[number][k] + motion_.eye_W;
  return triangle;
}

std::array<Triangle, 2> TreeBody::ends(std::uint32_t number) const {
  std::array<Triangle, 2> ends;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 arm_W = motion_.R_WC * triangles_C_[number][k];
    const Vec3 step_W = motion_.eye_step_W + motion_.turn_step_W.cross(arm_W);
    const Vec3 place_W = arm_W + motion_.eye_W;
    ends[0][k] = place_W - step_W;
    ends[1][k] = place_W + step_W;
  }
  return ends;
}

Vec3 TreeBody::moved_half(const Node& node) const {
  if (!is_moving_) return node.half;
  const Vec3 step_C = eye_step_C_ + turn_step_C_.cross(node.center);
  return node.half + largest_cross(turn_step_C_, node.half) + step_C.cwiseAbs();
}

MovedDirection TreeBody::moved(const Vec3& direction_C) const {
  // d·(τ × x) = (d × τ)·x.
  const Vec3 turned = direction_C.cross(turn_step_C_);
  return {direction_C + turned, direction_C - turned, direction_C.dot(eye_step_C_)};
}

TreeBody::Placed TreeBody::place_node(std::uint32_t number) const {
  const Node& node = tree_.nodes()[number];
  const Vec3 half = moved_half(node);
  const Vec3 center_W = motion_.R_WC * node.center + motion_.eye_W;
  const Vec3 half_W = abs_R_ * half;
  Placed placed{number, 0, 2.0 * half.maxCoeff(),
                BoxSides(Box(center_W - half_W, center_W + half_W)), axes_};
  for (Eigen::Index k = 0; k < 3; ++k) {
    placed.oblique.low_m[static_cast<std::size_t>(k)] = node.center[k] - half[k];
    placed.oblique.high_m[static_cast<std::size_t>(k)] = node.center[k] + half[k];
  }
  return placed;
}

std::uint32_t TreeBody::children_of(std::uint32_t place) {
  if (placed_[place].first_child != 0) return placed_[place].first_child;
  const std::uint32_t number = placed_[place].node;
  const auto first = static_cast<std::uint32_t>(placed_.size());
  placed_[place].first_child = first;
  placed_.push_back(place_node(number + 1));
  placed_.push_back(place_node(tree_.nodes()[number].second_child));
  return first;
}

bool TreeBody::may_touch(const Box& box_W, double rounding_m) const {
  const Vec3 center_C = to_body(box_W.center());
  const Vec3 half_C = abs_R_.transpose() * (0.5 * box_W.sizes()) + Vec3::Constant(rounding_m);
  std::array<std::uint32_t, geometry::TriangleTree::kMaxDepth + 1> waiting;
  std::size_t count = 0;
  waiting[count++] = 0;
  while (count > 0) {
    const std::uint32_t at = waiting[--count];
    const Node& node = tree_.nodes()[at];
    // In this order "not a number" may touch.
    if (((node.center - center_C).cwiseAbs().array() > (node.half + half_C).array()).any())
      continue;
    if (node.is_leaf()) return true;
    waiting[count++] = node.second_child;
    waiting[count++] = at + 1;
  }
  return false;
}

Box TreeBody::bounds() const {
  const BoxSides& sides = placed_.front().sides;
  return {Vec3(sides.low_m[0], sides.low_m[1], sides.low_m[2]),
          Vec3(sides.high_m[0], sides.high_m[1], sides.high_m[2])};
}

bool TreeBody::is_usable() const {
  const Box box = bounds();
  const double largest_m = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  // False for NaN.
  return largest_m + motion_.eye_W.lpNorm<1>() < geometry::kLargestCoordinate_m &&
         motion_.eye_step_W.allFinite() && motion_.turn_step_W.allFinite();
}

double TreeBody::scale_m(const Box& scene) const {
  const Vec3 around =
      Vec3::Constant(2.0 * tree_.nodes().front().radius_m) + motion_.eye_step_W.cwiseAbs();
  Box all = scene.merged(bounds());
  all.extend(Box(motion_.eye_W - around, motion_.eye_W + around));
  return all.sizes().maxCoeff();
}

double TreeBody::rounding_m(const Box& scene) const {
  const Box box = bounds();
  const double largest_m = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff() +
                           motion_.eye_W.lpNorm<Eigen::Infinity>();
  return kTreeScaleRounding * scale_m(scene) + kTreeCoordinateRounding * largest_m +
         geometry::kSmallestNormal;
}

}  // namespace camway::scene
