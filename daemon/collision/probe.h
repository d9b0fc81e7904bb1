// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "daemon/collision/obstacles.h"
#include "daemon/collision/tree_queries.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/path/stretch.h"
#include "daemon/scene/index/scene_index.h"

namespace camway::collision {

/// Result of checking one stretch.
struct ProbeResult {
  /// Proved: everywhere on the stretch the body keeps the required clearance, and all of it is
  /// within the bounds.
  bool free = false;
  /// Proved for the whole stretch: a part of the scene is inside a solid of the body, or a part of
  /// the body is inside a solid of the scene, in both cases without touching its surface; or a
  /// point of the body is beyond the bounds. If false, the body may still collide everywhere.
  bool contains = false;
  /// Bound of the distance of the body's points from their places at the middle of the stretch,
  /// rounding included.
  double reach_m = 0.0;
  /// The part of `reach_m` that is rounding; splitting the stretch does not reduce it.
  double rounding_m = 0.0;
  /// False if `gap_m` is only a lower bound: then the stretch is free and nothing was near.
  bool is_measured = true;
  /// How far the body is from colliding with something near at the middle of the stretch, as
  /// computed: distance less the required clearance, or depth inside the bounds. Another obstacle
  /// may be nearer, unless `Probe::refine` was called.
  double gap_m = 0.0;
  /// Estimated length of a free stretch, divided by the length of this one. If this stretch is
  /// free, the other one begins where it ends; otherwise both have the same beginning. Infinite if
  /// no obstacle was met.
  double step_scale = 0.0;

  /// Whether the body collides at the middle; known once the gap is measured.
  [[nodiscard]] bool collides() const { return !free && gap_m <= 0.0; }
  /// The part of `reach_m` that splitting reduces.
  [[nodiscard]] double motion_m() const { return reach_m - rounding_m; }
};

/// Checks stretches of a motion for collisions. Not thread-safe: each thread needs a probe of its
/// own.
///
/// The proof that a stretch is free: let d be the computed distance from the scene to the body's
/// triangles, placed as computed for the middle, with an error of at most e. In exact arithmetic,
/// every point of a triangle is, anywhere on the stretch, within `reach` of that place
/// (`motion::Stretch::reach_m`). So its distance from the scene is everywhere at least d - e -
/// reach. If that is more than the radius of the body's ball plus the required clearance, the whole
/// surface keeps the required clearance. Otherwise the direction of motion is used. Every point is
/// also within `motion::Stretch::bend_m` of the straight line between its places at the two ends;
/// this bound is much smaller than `reach`. So the hulls of these lines may keep the distance
/// although the first test fails (`scene::SceneIndex::swept`). A part that is inside a solid, of
/// the body or of the scene, without touching its surface is checked separately: if the surface is
/// free all the time, nothing enters or leaves the solid. Source: He & van den Berg 2014,
/// "Efficient exact collision-checking of 3-D rigid body motions using linear transformations and
/// distance computations in workspace", with our motion bounds; the check of motion along a
/// direction, for a slab, is after Mirtich 1996 ("Impulse-based dynamic simulation of rigid body
/// systems", section 2.3).
///
/// A side of the bounds is a half-space, so a condition that holds for the vertices of a triangle,
/// and for both ends of a straight line, holds for all of it. The body stays inside if each vertex
/// is inside at the middle by more than `reach` and the radius of the ball, or at both ends of its
/// way by more than `bend` and that radius. The depth of a vertex is one difference of doubles. The
/// required clearance applies to the scene alone, a margin to both.
class Probe {
 public:
  /// Refers to the sources of `obstacles` and to `body`, which must outlive it. [Limit: 0 <=
  /// clearance_m] [Units: metres]
  Probe(const Obstacles& obstacles, const motion::Body& body, double clearance_m);

  /// Default `share` of `refine`: a distance within a factor of 2 is enough to choose the next
  /// step.
  static constexpr double kRough = 0.5;

  enum class Way { kForwards, kBackwards };

  /// Checks a stretch, with `margin_m` added to the required clearance. `ProbeResult::step_scale`
  /// refers to the direction `way`. If the stretch is not free, `gap_m` is that of the triangle or
  /// side at which the check stopped; `refine` measures the nearest.
  ProbeResult check(const motion::Stretch& stretch, double margin_m = 0.0,
                    Way way = Way::kForwards);

  /// Returns `check(motion::standing_at(pose), margin_m).free`. Costs little where the triangle
  /// that stopped the last check is in the way again, as in a search that tries one pose after
  /// another.
  bool is_free(const motion::Pose& pose, double margin_m = 0.0);

  /// Measures `gap_m` after a `check` of the same stretch; does nothing if the stretch is free.
  /// Afterwards the true distance is at least `share` times the measured one, and exactly 0 if the
  /// measured one is 0.
  void refine(const motion::Stretch& stretch, ProbeResult& result, double share = kRough);

  /// `check`, then `refine`.
  ProbeResult check_refined(const motion::Stretch& stretch, double margin_m = 0.0,
                            double share = kRough);

  /// Returns an obstacle that the body touches at the middle of the stretch, or is too close to;
  /// nothing if there is none. The triangle `guess` is tried first. If there is such an obstacle,
  /// this is cheaper than `check_refined`.
  std::optional<std::uint32_t> touched_in_the_middle(const motion::Stretch& stretch,
                                                     std::uint32_t guess);

  /// Returns true only if it is proved that everywhere on the stretch the body collides with the
  /// triangle `obstacle` or is nearer to it than the required clearance. For a side of the bounds:
  /// that a vertex is everywhere beyond the side that it is farthest beyond at the middle.
  bool surely_collides_with(std::uint32_t obstacle, const motion::Stretch& stretch);

  /// Returns an obstacle for which `surely_collides_with` is true. Searches only among the bounds
  /// and the first few triangles that the body touches at the middle. If it returns nothing,
  /// nothing is proved.
  std::optional<std::uint32_t> surely_hit(const motion::Stretch& stretch);

  /// `ProbeResult::reach_m` of that stretch.
  [[nodiscard]] double reach_m(const motion::Stretch& stretch) const;
  /// `ProbeResult::rounding_m` of that stretch, without the rounding of distances.
  [[nodiscard]] double rounding_m(const motion::Stretch& stretch) const;
  /// Lower bound of the gap at the middle of `stretch` from the distance field; negative if the
  /// field cannot tell.
  [[nodiscard]] double at_least_m(const motion::Stretch& stretch) const {
    const double scene_m = field_distance_m(stretch) - required_distance_m_;
    return has_bounds_ ? std::min(scene_m, ball_depth_m(stretch) - body_.ball_radius_m()) : scene_m;
  }
  /// Places the body at the middle of `stretch`.
  void place(const motion::Stretch& stretch);
  /// Returns about the nearest triangle of the scene to the body as it was placed last, if it is
  /// nearer than `cutoff_m`. As `scene::SceneIndex::near`.
  std::optional<scene::Nearest> nearest_in_scene(double cutoff_m, double share);
  /// Calls `visit(number, part, index, obstacle)` for pairs of triangle `part` of the body as it
  /// was placed last, which has the number `number`, and triangle `obstacle` of the scene, until it
  /// returns false: for all that are within `within_m` of each other, and maybe others.
  template <class Visit>
  void for_each_pair(double within_m, const Visit& visit);
  /// Calls `visit(number, part, obstacle)` for triangle `obstacle` of the scene alone.
  template <class Visit>
  void for_each_pair_with(std::uint32_t obstacle, double within_m, const Visit& visit);
  /// Calls `visit(vertex, vertex_W)` for vertices of the body as it was placed last, until it
  /// returns false: for all that are at most `within_m` deep inside a side of the bounds, and maybe
  /// others.
  template <class Visit>
  void for_each_vertex(std::size_t side, double within_m, const Visit& visit) const;
  /// Box of the vertices of the body as it was placed last.
  [[nodiscard]] geometry::Box vertex_box() const;
  /// Vertex 3 × a triangle of the body + its index in it, as the body was placed last.
  [[nodiscard]] geometry::Vec3 vertex_W(std::size_t vertex) const;
  /// The triangle of the body, as it was placed last, that is nearest to a point.
  [[nodiscard]] std::uint32_t nearest_part(const geometry::Vec3& point_W);
  /// Depth of a point inside a solid of the body at the middle of `stretch`, about; nothing
  /// outside.
  [[nodiscard]] std::optional<double> depth_in_body_m(const motion::Stretch& stretch,
                                                      const geometry::Vec3& point_W);
  [[nodiscard]] const Obstacles& obstacles() const { return obstacles_; }
  [[nodiscard]] const motion::Body& body() const { return body_; }
  /// The vertex and the side of the bounds with the least depth inside, as computed, for the body
  /// as it was placed last; nothing without bounds.
  [[nodiscard]] std::optional<VertexAtSide> least_deep_vertex() const;
  /// Distance that the body's triangles must have from the triangles of the scene: radius of its
  /// ball, plus the required clearance, plus the error of smooth surfaces.
  [[nodiscard]] double required_distance_m() const { return required_distance_m_; }

 private:
  /// Upper bound of the rounding of a sum of a few positive numbers, half an epsilon each.
  static constexpr double kRoundUp = 1.0 + 4.0 * std::numeric_limits<double>::epsilon();

  [[nodiscard]] ProbeResult check_scene(const motion::Stretch& stretch, double margin_m, Way way);
  /// Adds the check of the bounds to that of the scene.
  void check_bounds(const motion::Stretch& stretch, double margin_m, Way way, ProbeResult& result);
  /// Lower bound of the depth of the body's triangles inside the bounds.
  [[nodiscard]] double ball_depth_m(const motion::Stretch& stretch) const;
  /// Least depths for the body as it was moved last.
  [[nodiscard]] Depths least_depths() const;
  /// Moves the body along the stretch.
  void move(const motion::Stretch& stretch, Way way);
  /// Whether the body as it was moved last keeps `keep_m` and the error of distances, which is
  /// added to `rounding_m`, from the scene. Returns nothing if the motion is too large to know.
  std::optional<scene::SweptResult> swept(const motion::Stretch& stretch, double keep_m,
                                          double& rounding_m);
  /// Whether triangle `obstacle` of the scene is surely nearer to the body as it was moved last
  /// than `margin_m` and the required clearance. Requires a body without a tree.
  [[nodiscard]] bool is_surely_near(std::uint32_t obstacle, double margin_m);
  /// The linear bound with these values at the eye and at the body's radius.
  [[nodiscard]] scene::RadialBound radial(double at_eye_m, double at_radius_m) const;
  bool touches(const geometry::Triangle& obstacle);
  [[nodiscard]] double bend_m(const motion::Stretch& stretch) const {
    return (stretch.bend_m(radius_m_) + body_.slack_m()) * kRoundUp;
  }
  [[nodiscard]] geometry::Box box_W() const;
  [[nodiscard]] double field_distance_m(const motion::Stretch& stretch) const;
  [[nodiscard]] bool holds_scene(const motion::Stretch& stretch);
  /// Whether a part of the body as it was placed last is inside a solid of the scene. Requires that
  /// no part touches a triangle of the scene.
  [[nodiscard]] bool is_in_solid() const;
  /// Checks the body as it was placed last, for motions up to `moved_m`.
  [[nodiscard]] bool surely_leaves(double moved_m) const;
  [[nodiscard]] bool surely_meets(const geometry::Triangle& part,
                                  const geometry::Triangle& obstacle, double moved_m) const;
  /// False only if `surely_meets` is false for all pairs.
  [[nodiscard]] bool may_surely_meet(double moved_m) const;
  std::optional<std::uint32_t> surely_hit_by_few(double moved_m);
  std::optional<std::uint32_t> surely_hit_by_tree(double moved_m);
  [[nodiscard]] bool is_in_body(const motion::Stretch& stretch,
                                const geometry::Vec3& point_W) const;

  Obstacles obstacles_;
  const motion::Body& body_;
  bool has_bounds_;
  double required_distance_m_;
  double radius_m_;
  double center_radius_m_;  ///< radius of a ball about the middle of the body's box
  /// The body on the stretch, if it has a tree; otherwise its triangles, and two ends of each.
  std::optional<TreeQueries> tree_;
  std::vector<geometry::Triangle> placed_;
  std::vector<geometry::Triangle> ends_;
  std::optional<std::uint32_t> stopped_by_;  ///< triangle near which the last check ended unproved
};

template <class Visit>
void Probe::for_each_pair(double within_m, const Visit& visit) {
  if (tree_) {
    tree_->for_each_pair(within_m, [&](std::uint32_t number, std::uint32_t index,
                                       const geometry::Triangle& obstacle) {
      return visit(number, tree_->triangle(number), index, obstacle);
    });
    return;
  }
  geometry::Box box = box_W();
  box = {box.min() - geometry::Vec3::Constant(within_m),
         box.max() + geometry::Vec3::Constant(within_m)};
  obstacles_.index.for_each_touching(box, [&](std::uint32_t index) {
    const geometry::Triangle obstacle = obstacles_.index.triangle(index);
    for (std::uint32_t i = 0; i < placed_.size(); ++i) {
      if (!visit(i, placed_[i], index, obstacle)) return false;
    }
    return true;
  });
}

template <class Visit>
void Probe::for_each_vertex(std::size_t side, double within_m, const Visit& visit) const {
  if (tree_) {
    tree_->for_each_leaf(side, within_m, [&](std::uint32_t number) {
      const geometry::Triangle placed = tree_->triangle(number);
      return visit(3 * std::size_t{number}, placed[0]) &&
             visit(3 * std::size_t{number} + 1, placed[1]) &&
             visit(3 * std::size_t{number} + 2, placed[2]);
    });
    return;
  }
  for (std::size_t vertex = 0; vertex < 3 * placed_.size(); ++vertex) {
    if (!visit(vertex, vertex_W(vertex))) return;
  }
}

template <class Visit>
void Probe::for_each_pair_with(std::uint32_t index, double within_m, const Visit& visit) {
  const geometry::Triangle obstacle = obstacles_.index.triangle(index);
  if (tree_) {
    tree_->for_each_pair_with(index, obstacle, within_m,
                              [&](std::uint32_t number, std::uint32_t, const geometry::Triangle&) {
                                return visit(number, tree_->triangle(number), obstacle);
                              });
    return;
  }
  for (std::uint32_t i = 0; i < placed_.size(); ++i) {
    if (!visit(i, placed_[i], obstacle)) return;
  }
}

}  // namespace camway::collision
