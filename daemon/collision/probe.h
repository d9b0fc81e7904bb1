// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/collision/obstacles.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/path/stretch.h"
#include "daemon/scene/index/scene_index.h"

namespace camway::collision {

/// What one look at a stretch tells about all of it.
struct Look {
  /// Proved: nowhere on the stretch is the body nearer to the scene than the required clearance, or
  /// a point of it beyond the bounds.
  bool free = false;
  /// Proved: everywhere on the stretch a part of the scene is inside a solid of the body, or a part
  /// of the body inside a solid of the scene, away from its surface, or a point of the body beyond
  /// the bounds. Where this is false the body may collide everywhere as well.
  bool swallows = false;
  /// Bound of the motion of the body's points from where they were looked at, rounding included.
  double reach_m = 0.0;
  /// The part of it that splitting does not take away.
  double rounding_m = 0.0;
  /// Whether `gap_m` was measured; else it is a lower bound, and the stretch is free.
  bool is_measured = true;
  /// How far the body was in the middle from colliding with something near, as computed: distance
  /// less the required clearance, or how far it was inside the bounds. Something else may be
  /// nearer, unless `Probe::measure` has looked.
  double gap_m = 0.0;
  /// An estimate: how many times as long a stretch can be free, the next one if this is free, else
  /// another one from the same beginning. Infinity where nothing was met.
  double ahead = 0.0;

  /// In the middle it collides, or is too close; known once it is measured.
  [[nodiscard]] bool collides() const { return !free && gap_m <= 0.0; }
  /// What splitting can take away.
  [[nodiscard]] double motion_m() const { return reach_m - rounding_m; }
};

/// Looks at stretches of a motion. Each thread needs a probe of its own: what places the body uses
/// a buffer of the probe.
///
/// The proof that a stretch is free: let d be the computed distance from the scene to the body's
/// triangles where they were computed to be in the middle, off by at most e. Every point of a
/// triangle is, anywhere on the stretch and in exact arithmetic, within `reach` of there
/// (`motion::Stretch::reach_m`). So its distance is everywhere at least d - e - reach; if that is
/// more than the radius of the body's ball and the required clearance together, all of the surface
/// is further away than required. Where it is not, the direction of the motion counts: a point is
/// also within `motion::Stretch::bend_m`, which is much less, of the line between its two ends, and
/// what these lines hold may keep away all the same (`scene::SceneIndex::passage`). What is inside
/// a solid without touching its surface, of the body or of the scene, is asked for apart: if the
/// surface is free all the time, nothing can have come in or gone out. Source: He & van den Berg
/// 2014, "Efficient exact collision-checking of 3-D rigid body motions using linear transformations
/// and distance computations in workspace", with our motion bounds; that of motion along a
/// direction, for a slab, is after Mirtich 1996 ("Impulse-based dynamic simulation of rigid body
/// systems", section 2.3).
///
/// A side of the bounds is a half-space, so what holds for the vertices of a triangle, and for both
/// ends of a straight line, holds for all of it. The body stays inside if each vertex is, in the
/// middle, by more than `reach` and the radius of the ball; or at both ends of its way by more than
/// `bend` and that radius. How far a vertex is inside is one difference of doubles. The required
/// clearance is about the scene alone, a margin about both.
class Probe {
 public:
  /// Refers to both, which must outlive it. [Limit: 0 <= clearance_m] [Units: metres]
  Probe(const Obstacles& obstacles, const motion::Body& body, double clearance_m);

  /// The distance that a look gives need not be nearer to the truth to be of use for the next step.
  static constexpr double kRough = 0.5;

  enum class Way { kForwards, kBackwards };

  /// Looks at a stretch. `margin_m` is asked for on top of the required clearance. `Look::ahead` is
  /// about the way that is gone. Of one that is not free, whether it collides is not told.
  Look glance(const motion::Stretch& stretch, double margin_m = 0.0, Way way = Way::kForwards);

  /// Improves `gap_m` of a glance at that stretch, unless it is free: the true distance is at least
  /// `share` of it afterwards, and 0 exactly if it says so.
  void measure(const motion::Stretch& stretch, Look& look, double share = kRough);

  /// Both.
  Look look(const motion::Stretch& stretch, double margin_m = 0.0, double share = kRough);

  /// An obstacle that the body touches in the middle of the stretch, or is too close to; `guess` is
  /// tried first among triangles. Cheaper than a look where there is one.
  std::optional<std::uint32_t> touched_in_the_middle(const motion::Stretch& stretch,
                                                     std::uint32_t guess);

  /// Proved: everywhere on the stretch the body collides with `obstacle` (`Obstacles` has the
  /// numbers), or is nearer to it than the required clearance.
  bool surely_collides_with(std::uint32_t obstacle, const motion::Stretch& stretch);

  /// An obstacle of which that is proved, sought among the bounds and the first few triangles that
  /// the body touches in the middle; nothing proves that there is none.
  std::optional<std::uint32_t> surely_hit(const motion::Stretch& stretch);

  /// `Look::reach_m` of that stretch.
  [[nodiscard]] double reach_m(const motion::Stretch& stretch) const;
  /// `Look::rounding_m` of that stretch, that of distances apart.
  [[nodiscard]] double rounding_m(const motion::Stretch& stretch) const;
  /// Bound of the gap in the middle of `stretch` at the cost of a look-up; below 0 where the
  /// distance field does not tell.
  [[nodiscard]] double at_least_m(const motion::Stretch& stretch) const {
    const double scene_m = field_distance_m(stretch) - keep_m_;
    return has_bounds_ ? std::min(scene_m, ball_depth_m(stretch) - body_.ball_radius_m()) : scene_m;
  }
  /// The body's triangles where the middle of `stretch` has them; valid until the next call.
  std::span<const geometry::Triangle> place(const motion::Stretch& stretch);
  [[nodiscard]] const Obstacles& obstacles() const { return obstacles_; }
  [[nodiscard]] const motion::Body& body() const { return body_; }
  /// The side of the bounds that the body as it was placed last is beyond the most, or the least
  /// inside of, with how far it is inside, as computed; nothing without bounds.
  struct Edge {
    std::size_t side = 0;
    std::size_t vertex = 0;  ///< of the body: three times its triangle, and which of the three
    double gap_m = 0.0;
  };
  [[nodiscard]] std::optional<Edge> nearest_edge() const;
  /// Distance of the body's triangles from the scene at which it collides: ball and clearance.
  [[nodiscard]] double keep_m() const { return keep_m_; }

 private:
  [[nodiscard]] Look glance_at_scene(const motion::Stretch& stretch, double margin_m, Way way);
  /// Adds what the bounds ask to what was seen of the scene.
  void mind_bounds(const motion::Stretch& stretch, double margin_m, Way way, Look& look);
  /// How far all of the body's triangles are inside the bounds, at least.
  [[nodiscard]] double ball_depth_m(const motion::Stretch& stretch) const;
  /// The body on the stretch; valid until it is placed again.
  scene::MovingBody move(const motion::Stretch& stretch, Way way);
  [[nodiscard]] double field_distance_m(const motion::Stretch& stretch) const;
  [[nodiscard]] bool holds_scene(const motion::Stretch& stretch);
  /// Whether a part of the body as it was placed last is inside a solid of the scene. Precondition:
  /// none of them touches a triangle of the scene.
  [[nodiscard]] bool is_in_solid() const;
  /// Of the body as it was placed last.
  [[nodiscard]] bool surely_leaves(double moved_m) const;
  [[nodiscard]] bool surely_meets(const geometry::Triangle& obstacle, double moved_m) const;

  Obstacles obstacles_;
  const motion::Body& body_;
  bool has_bounds_;
  double keep_m_;
  double radius_m_;
  geometry::Vec3 center_C_;       ///< of a ball about the body's triangles
  double center_radius_m_ = 0.0;  ///< of that ball
  std::vector<geometry::Triangle> placed_;
  std::vector<geometry::Triangle> ends_;  ///< of each triangle two
};

}  // namespace camway::collision
