// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "daemon/scene/index/scene_index.h"
#include "daemon/scene/index/tree_body.h"

namespace camway::scene {

/// Base class of searches over pairs of a triangle of a `TreeBody` and one of the scene, the most
/// promising first. Both trees are descended together (`TreeWalk`); a pair of nodes is passed over
/// where their boxes prove it to be beyond a reach. The derived class defines the reach and the
/// test of a pair of triangles. `SceneIndex::search` runs it.
class TreeSearch {
 public:
  TreeSearch(const TreeSearch&) = delete;
  TreeSearch& operator=(const TreeSearch&) = delete;

  [[nodiscard]] TreeBody& body() { return body_; }
  [[nodiscard]] bool is_done() const { return is_done_; }
  void enter(const IndexedPart& part) { part_ = &part; }

  /// Square of the reach of a node of the body, rounded up.
  [[nodiscard]] double squared_reach_m2(const geometry::TriangleTree::Node& node) const {
    const double reach_m = limit_.at(node.radius_m) + rounding_m_;
    return reach_m * reach_m * kSquareRoundUp;
  }
  /// Whether a squared distance between boxes (`BoxGaps`) is beyond the reach of a node.
  [[nodiscard]] bool is_beyond(const geometry::TriangleTree::Node& node,
                               double squared_box_m2) const {
    return squared_box_m2 > squared_reach_m2(node) * (1.0 + 2.0 * kBoxGapRelativeError);
  }

  /// Tests the triangles below node `node` of the body against scene triangle `index` of the part
  /// that was entered.
  void ask(std::uint32_t node, std::uint32_t index) { ask(node, index, part_->triangle(index)); }
  /// The same for a triangle of any part.
  void ask(std::uint32_t node, std::uint32_t index, const geometry::Triangle& triangle);
  /// Tests one pair before the search.
  void ask_first(std::uint32_t number, std::uint32_t index, const geometry::Triangle& triangle);

 protected:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// `scene`: bounds of the scene. Requires a body that is usable.
  TreeSearch(TreeBody& body, const geometry::Box& scene);
  virtual ~TreeSearch() = default;

  /// From now on only pairs nearer than this are tested.
  void set_limit(const RadialBound& limit) { limit_ = limit; }
  void finish() { is_done_ = true; }
  /// Sets the direction, in frame C, of a slab that may separate other parts of the body from the
  /// triangle that is being asked about.
  void try_direction(const geometry::Vec3& direction_C) { asked_.slab = slab_across(direction_C); }

 private:
  /// A square, a sum and a product of numbers that are 0 or more.
  static constexpr double kSquareRoundUp = 1.0 + 0x1p-48;

  /// A direction in frame C, and the extent of the triangle that is being asked about along it.
  struct Slab {
    MovedDirection direction;
    double length = 0.0;
    double low = 0.0;
    double high = 0.0;
  };
  /// The triangle of the scene that is being asked about, in frame C.
  struct Asked {
    geometry::Box box_C;
    geometry::Triangle triangle_C;
    Slab slab;  ///< tried first
  };
  struct Waiting {
    double squared_m2;  ///< lower bound of the squared distance
    std::uint32_t node;
  };

  /// Tests triangle `number` of the body, no vertex of which is farther than `radius_m` from the
  /// eye, against scene triangle `index`.
  virtual void ask_pair(std::uint32_t number, double radius_m, std::uint32_t index,
                        const geometry::Triangle& triangle) = 0;

  void prepare(const geometry::Triangle& triangle);
  void ask_leaf(const geometry::TriangleTree::Node& leaf, std::uint32_t index,
                const geometry::Triangle& triangle);
  [[nodiscard]] double squared_gap_m2(const geometry::TriangleTree::Node& node) const;
  [[nodiscard]] Slab slab_across(const geometry::Vec3& direction_C) const;
  /// The slab across the shortest line from the triangle to a point, about.
  [[nodiscard]] Slab slab_towards(const geometry::Vec3& point_C) const;
  /// Width of the slab between the triangle that is being asked about and what is given of the
  /// body, at both ends of the motion; 0 or less if it does not separate them.
  static double gap_across(const Slab& slab, const geometry::TriangleTree::Node& node);
  static double gap_across(const Slab& slab, const geometry::Triangle& part_C);
  /// Whether a slab proves that the node is beyond the reach.
  [[nodiscard]] bool is_separate(const geometry::TriangleTree::Node& node) const;

  TreeBody& body_;
  const IndexedPart* part_ = nullptr;
  RadialBound limit_;
  double rounding_m_;
  bool is_done_ = false;
  Asked asked_;
};

/// The search of the nearest pair. As `DistanceSearch`, without a rule for ties.
class TreeDistance : public TreeSearch {
 public:
  /// A pair of triangles.
  struct Pair {
    std::uint32_t number = 0;    ///< of the body
    std::uint32_t triangle = 0;  ///< of the scene
  };

  /// As `SceneIndex::near`, or `SceneIndex::any_within` with the goal `kAny`.
  TreeDistance(TreeBody& body, const geometry::Box& scene, double cutoff_m, DistanceGoal goal,
               double certain_m = 0.0, double share = 1.0);

  [[nodiscard]] std::optional<Nearest> result() const;
  [[nodiscard]] std::optional<Pair> pair() const;

 private:
  void ask_pair(std::uint32_t number, double radius_m, std::uint32_t index,
                const geometry::Triangle& triangle) final;

  DistanceGoal goal_;
  double certain_m_;
  double share_;
  double limit_m_;
  Nearest best_;
  std::uint32_t number_ = 0;
};

/// The distances that a moving body keeps from the scene, as `SweptBody` has them. The bounds are
/// those of a point at a distance from the eye.
struct TreeMargins {
  RadialBound bend;
  RadialBound reach;
  double keep_m = 0.0;
};

/// The search of whether a moving body keeps its distance from the scene. As `SweptSearch`.
class TreeSwept : public TreeSearch {
 public:
  TreeSwept(TreeBody& body, const geometry::Box& scene, const TreeMargins& margins);

  [[nodiscard]] SweptResult result() const;
  /// The pair that was not proved clear, or else the last one that was tested.
  [[nodiscard]] std::optional<TreeDistance::Pair> pair() const;

 private:
  /// Most near pairs that are proved clear one by one; with more in reach, shorter motions are
  /// cheaper. More than those of `SweptSearch`, since a triangle of many is small.
  static constexpr int kMostPassed = 128;

  void ask_pair(std::uint32_t number, double radius_m, std::uint32_t index,
                const geometry::Triangle& triangle) final;
  bool passes(std::uint32_t number, const geometry::Triangle& triangle,
              const geometry::Vec3& direction_W, double limit_m, double bend_m);
  void stop_before(std::uint32_t number, const geometry::Triangle& triangle, double bend_m,
                   double reach_m);

  TreeMargins margins_;
  int passed_ = 0;
  bool is_clear_ = true;
  Nearest nearest_;
  TreeDistance::Pair pair_;
  double ahead_ = std::numeric_limits<double>::infinity();
};

/// Visits all pairs whose boxes may be within a distance.
template <class Visit>
class TreePairs : public TreeSearch {
 public:
  /// `visit(number, index, triangle)` returns whether to go on.
  TreePairs(TreeBody& body, const geometry::Box& scene, double within_m, const Visit& visit)
      : TreeSearch(body, scene), visit_(visit) {
    set_limit({within_m, 0.0});
  }

 private:
  void ask_pair(std::uint32_t number, double, std::uint32_t index,
                const geometry::Triangle& triangle) final {
    if (!visit_(number, index, triangle)) finish();
  }

  const Visit& visit_;
};

}  // namespace camway::scene
