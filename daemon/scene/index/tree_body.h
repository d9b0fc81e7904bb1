// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "daemon/geometry/triangle_tree.h"
#include "daemon/scene/index/box_gaps.h"

namespace camway::scene {

/// A place of a body and the first order of its motion there, as `motion::Stretch` has it: from the
/// middle of the motion to its end the point `R_WC * x + eye_W` moves by `eye_step_W +
/// turn_step_W.cross(R_WC * x)`, to its beginning by the negative of that. [Units: metres]
struct BodyMotion {
  Eigen::Matrix3d R_WC;  ///< a rotation, each entry rounded by at most 16 units
  geometry::Vec3 eye_W;
  geometry::Vec3 eye_step_W = geometry::Vec3::Zero();
  geometry::Vec3 turn_step_W = geometry::Vec3::Zero();  ///< [Limit: length <= 1]
};

/// A bound that grows linearly with the distance of a point from the eye.
struct RadialBound {
  double at_eye_m = 0.0;
  double per_m = 0.0;

  [[nodiscard]] double at(double radius_m) const { return at_eye_m + per_m * radius_m; }
};

/// A direction in the frame of the body, and what the first order of the motion makes of it: along
/// it the point x is at `ahead·x + ahead_m` at the end of the motion, at `behind·x - ahead_m` at
/// its beginning.
struct MovedDirection {
  geometry::Vec3 ahead;
  geometry::Vec3 behind;
  double ahead_m;
};

/// A body of many triangles at a place or on a short motion. The body's tree stays in its own frame
/// C; triangles and boxes are placed when a search comes to them, so that placing a body costs
/// nothing. Refers to the tree and the triangles, which must outlive it.
///
/// Not thread-safe.
class TreeBody {
 public:
  /// A node of the tree with its boxes. They hold the node's triangles at both ends of the motion,
  /// and so the straight lines in between.
  struct Placed {
    std::uint32_t node;
    std::uint32_t first_child;  ///< place of the first child among the placed nodes; 0 if not yet
    double size_m;              ///< longest side
    BoxSides sides;
    ObliqueSides oblique;
  };

  /// `tree` is that of `triangles_C`. A search requires that the body was placed.
  TreeBody(const geometry::TriangleTree& tree, std::span<const geometry::Triangle> triangles_C)
      : tree_(tree), triangles_C_(triangles_C) {}

  /// Places the body where it stands, or moves.
  void place(const BodyMotion& motion);

  [[nodiscard]] const geometry::TriangleTree& tree() const { return tree_; }
  [[nodiscard]] const BodyMotion& motion() const { return motion_; }
  [[nodiscard]] std::size_t size() const { return triangles_C_.size(); }

  /// Triangle `number` at the middle of the motion, as `R_WC * x + eye_W` in doubles.
  [[nodiscard]] geometry::Triangle middle(std::uint32_t number) const;
  /// Triangle `number` at the beginning and at the end, to first order.
  [[nodiscard]] std::array<geometry::Triangle, 2> ends(std::uint32_t number) const;
  [[nodiscard]] const geometry::Triangle& triangle_C(std::uint32_t number) const {
    return triangles_C_[number];
  }

  /// Place of the root among the placed nodes.
  static constexpr std::uint32_t kRoot = 0;
  /// A placed node. The reference is valid until the next call of `children_of`.
  [[nodiscard]] const Placed& placed(std::uint32_t place) const { return placed_[place]; }
  [[nodiscard]] const geometry::TriangleTree::Node& node(std::uint32_t number) const {
    return tree_.nodes()[number];
  }
  [[nodiscard]] const geometry::TriangleTree::Node& node_at(std::uint32_t place) const {
    return node(placed_[place].node);
  }
  /// Place of the first child of a node that is no leaf; the second child follows it.
  std::uint32_t children_of(std::uint32_t place);

  /// `point_W` in the frame of the body at the middle of the motion.
  [[nodiscard]] geometry::Vec3 to_body(const geometry::Vec3& point_W) const {
    return motion_.R_WC.transpose() * (point_W - motion_.eye_W);
  }
  /// The bound of the half sides of a node's box in frame C that holds both ends of its motion.
  [[nodiscard]] geometry::Vec3 moved_half(const geometry::TriangleTree::Node& node) const;
  [[nodiscard]] MovedDirection moved(const geometry::Vec3& direction_C) const;

  /// False only if no triangle of the body, at the middle of the motion, touches `box_W`.
  /// `rounding_m`: of this body and a scene that holds the box.
  [[nodiscard]] bool may_touch(const geometry::Box& box_W, double rounding_m) const;

  /// Box in the world that holds the body, both ends of its motion included, up to `rounding_m`.
  [[nodiscard]] geometry::Box bounds() const;
  /// Whether the kernels of daemon/geometry accept all of its coordinates.
  [[nodiscard]] bool is_usable() const;
  /// Bound of the rounding of all boxes and bounds of this body against triangles in `scene`: a
  /// computed triangle of the body may be this much outside of its boxes, and a gap this much too
  /// long. [Units: metres]
  [[nodiscard]] double rounding_m(const geometry::Box& scene) const;
  /// Bound of the coordinates' differences in any axis, of the body's triangles and of `scene`.
  [[nodiscard]] double scale_m(const geometry::Box& scene) const;

 private:
  friend class TreeWalk;

  /// A pair of nodes that a walk comes to later.
  struct Waiting {
    double squared_m2;
    std::uint32_t place;  ///< of the node of the body
    std::uint32_t node;   ///< of the scene; of a leaf its parent
    std::uint32_t leaf;
  };
  /// A triangle of the scene near a node of the body.
  struct Near {
    double squared_m2;
    std::uint32_t triangle;
  };
  struct Met {
    std::uint32_t place;
    std::uint32_t triangle;
  };

  [[nodiscard]] Placed place_node(std::uint32_t node) const;

  const geometry::TriangleTree& tree_;
  std::span<const geometry::Triangle> triangles_C_;
  BodyMotion motion_;
  Eigen::Matrix3d abs_R_ = Eigen::Matrix3d::Zero();
  geometry::Vec3 eye_step_C_ = geometry::Vec3::Zero();
  geometry::Vec3 turn_step_C_ = geometry::Vec3::Zero();
  bool is_moving_ = false;
  ObliqueSides axes_;  ///< origin and axes of all boxes
  std::vector<Placed> placed_;
  // Memory of walks, kept from one to the next.
  std::vector<Waiting> waiting_;
  std::vector<Near> entries_;
  std::array<Met, 64> met_;
};

/// Rounding of a body's boxes and bounds in units of u = 2^-53, as lengths, with S the bound of the
/// differences of coordinates (`TreeBody::scale_m`, which counts the eye) and W that of the body's
/// own coordinates. R differs from a rotation by at most 48u in norm (16u an entry).
/// 1. A point of the scene in frame C: the difference 2S, the product with three roundings 9S, that
///    R is no rotation 96S: 107S.
/// 2. A triangle of the body: its products 6S, the step's 12S; R and the first order in frame C,
///    where R is taken for a rotation: 96S for the place and, with a turn of at most 1, as much for
///    each part of the step: 306S. The sums with the eye, of triangles, boxes and centres: 16W.
/// 3. A gap along axes that are not quite orthonormal is too long by 48u of itself, at most
///    sqrt(3)·S: 84S. Its own products and sums: 27S. Along a direction d, divided by |d|, less.
/// Together 524S + 16W.
inline constexpr double kTreeScaleRounding = 1024.0 * 0x1p-53;
inline constexpr double kTreeCoordinateRounding = 32.0 * 0x1p-53;

}  // namespace camway::scene
