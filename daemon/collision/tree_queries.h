// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "daemon/collision/obstacles.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/path/stretch.h"
#include "daemon/scene/index/scene_index.h"
#include "daemon/scene/index/tree_search.h"

namespace camway::collision {

/// A vertex of the body and a side of the bounds.
struct VertexAtSide {
  std::size_t side = 0;
  std::size_t vertex = 0;  ///< vertex of the body: 3 × its triangle + its index in it
  double gap_m = 0.0;      ///< depth of the vertex inside the side, less the radius of the ball
};

/// Least depths of the body's vertices inside the bounds: at the middle of a stretch, and at its
/// ends in the direction of the check.
struct Depths {
  double middle_m = std::numeric_limits<double>::infinity();
  double first_m = std::numeric_limits<double>::infinity();
  double last_m = std::numeric_limits<double>::infinity();
};

/// The queries of `Probe` for a body that has a tree. They remember the pair of triangles that
/// decided the last one and look at it first: from one step of a path to the next it mostly decides
/// again. Refers to the sources of the obstacles and to the body, which must outlive it.
///
/// Not thread-safe.
class TreeQueries {
 public:
  /// Requires a body that has a tree.
  TreeQueries(const Obstacles& obstacles, const motion::Body& body);

  /// Places the body at the middle of `stretch`.
  void place(const motion::Stretch& stretch);
  /// Moves the body along `stretch`, backwards if `is_backwards`.
  void move(const motion::Stretch& stretch, bool is_backwards);

  /// Bound of the errors of distances from the body as it was placed last.
  [[nodiscard]] double error_m() const;
  /// As `scene::SceneIndex::swept`, for the body as it was moved last.
  scene::SweptResult swept(const scene::TreeMargins& margins);
  /// As `scene::SceneIndex::near` and `any_within`, for the body as it was placed last.
  std::optional<scene::Nearest> near(double cutoff_m, double share);
  std::optional<scene::Nearest> any_within(double distance_m);
  /// Whether the body as it was placed last touches `obstacle`.
  bool touches(const geometry::Triangle& obstacle);

  /// Calls `visit(number, index, triangle)` for pairs of a triangle of the body as it was placed
  /// last and one of the scene, until it returns false: for all that are within `within_m` of each
  /// other, and maybe others.
  template <class Visit>
  void for_each_pair(double within_m, const Visit& visit) {
    if (!body_.is_usable()) return;
    scene::TreePairs<Visit> pairs(body_, obstacles_.index.bounds(), within_m, visit);
    obstacles_.index.search(pairs);
  }
  /// The same for one triangle of the scene.
  template <class Visit>
  void for_each_pair_with(std::uint32_t index, const geometry::Triangle& obstacle, double within_m,
                          const Visit& visit) {
    if (!body_.is_usable()) return;
    scene::TreePairs<Visit> pairs(body_, geometry::bounds(obstacle), within_m, visit);
    pairs.ask(0, index, obstacle);
  }
  /// The triangle of the body nearest to a point, and its distance.
  scene::Nearest nearest_part(const geometry::Vec3& point_W);

  [[nodiscard]] const scene::TreeBody& body() const { return body_; }
  [[nodiscard]] geometry::Triangle triangle(std::uint32_t number) const {
    return body_.middle(number);
  }
  /// Box that holds the body as it was placed or moved last.
  [[nodiscard]] geometry::Box bounds() const { return body_.bounds(); }

  /// As `Probe::least_deep_vertex` and `Depths`, for the body as it was placed or moved last.
  [[nodiscard]] VertexAtSide least_deep_vertex() const;
  [[nodiscard]] Depths least_depths() const;
  /// Calls `visit(number)` for triangles of the body as it was placed last, until it returns false:
  /// for all with a vertex that is at most `within_m` deep inside a side of the bounds, and maybe
  /// others, the least deep nodes first.
  template <class Visit>
  void for_each_leaf(std::size_t side, double within_m, const Visit& visit) const {
    descend(
        depth_in(obstacles_.bounds, side, Instant::kMiddle), [&] { return within_m; },
        [&](const geometry::TriangleTree::Node& leaf) {
          for (std::uint32_t i = leaf.begin; i < leaf.end; ++i) {
            if (!visit(body_.tree().order()[i])) return false;
          }
          return true;
        });
  }
  /// The box of the vertices as they were placed last.
  [[nodiscard]] geometry::Box vertex_box() const;

 private:
  /// Runs a search, the pair that decided the last one first, and notes the pair that decides it.
  template <class Search>
  void run(Search& search) {
    if (last_pair_) {
      search.ask_first(last_pair_->number, last_pair_->triangle,
                       obstacles_.index.triangle(last_pair_->triangle));
    }
    if (!search.is_done()) obstacles_.index.search(search);
    if (search.pair()) last_pair_ = search.pair();
  }

  /// When a vertex is looked at.
  enum class Instant : std::uint8_t { kBegin, kMiddle, kEnd };
  /// The depth inside a side of the nodes of a body: a box is nowhere deeper than its vertices.
  struct SideDepth {
    const geometry::Bounds& bounds;
    std::size_t side;
    Instant instant;
    geometry::Vec3 along;  ///< direction inwards, in frame C, at the instant
    double offset_m;       ///< depth of the eye, less the rounding of boxes

    [[nodiscard]] double at_least_m(const geometry::TriangleTree::Node& node) const {
      return offset_m + along.dot(node.center) - along.cwiseAbs().dot(node.half);
    }
  };
  [[nodiscard]] SideDepth depth_in(const geometry::Bounds& bounds, std::size_t side,
                                   Instant instant) const;
  /// Replaces `least` by the vertex of least depth, if that is less.
  void find_least(const SideDepth& depth, VertexAtSide& least) const;
  /// Calls `visit(leaf)` for the leaves that may be at most `limit_m()` deep, the less deep ones
  /// first, until it returns false.
  template <class Limit, class Visit>
  void descend(const SideDepth& depth, const Limit& limit_m, const Visit& visit) const;
  void find_least_in_leaf(const SideDepth& depth, const geometry::TriangleTree::Node& leaf,
                          VertexAtSide& least) const;
  [[nodiscard]] VertexAtSide least_depth(Instant instant) const;

  Obstacles obstacles_;
  const motion::Body& motion_body_;
  scene::TreeBody body_;
  std::optional<scene::TreeDistance::Pair> last_pair_;
};

template <class Limit, class Visit>
void TreeQueries::descend(const SideDepth& depth, const Limit& limit_m, const Visit& visit) const {
  std::array<std::uint32_t, geometry::TriangleTree::kMaxDepth + 1> waiting;
  std::size_t count = 0;
  waiting[count++] = 0;
  while (count > 0) {
    const std::uint32_t at = waiting[--count];
    const geometry::TriangleTree::Node& node = body_.node(at);
    // In this order "not a number" is looked into.
    if (depth.at_least_m(node) > limit_m()) continue;
    if (node.is_leaf()) {
      if (!visit(node)) return;
      continue;
    }
    std::uint32_t near = at + 1;
    std::uint32_t far = node.second_child;
    if (depth.at_least_m(body_.node(far)) < depth.at_least_m(body_.node(near)))
      std::swap(near, far);
    waiting[count++] = far;
    waiting[count++] = near;
  }
}

}  // namespace camway::collision
