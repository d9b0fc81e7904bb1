// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/geometry/rounding.h"
#include "daemon/geometry/segment_triangle.h"
#include "daemon/geometry/triangle_box.h"
#include "daemon/geometry/triangle_distance.h"
#include "daemon/geometry/triangle_intersection.h"
#include "daemon/scene/distance_search.h"
#include "daemon/scene/index_walk.h"
#include "daemon/scene/passage_search.h"
#include "daemon/scene/scene_index.h"

namespace camway::scene {

using geometry::Box;
using geometry::LineSegment;
using geometry::Triangle;
using geometry::Vec3;

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Whether the kernels of daemon/geometry accept the point; false for NaN.
bool is_usable(const Vec3& point) {
  return (point.array().abs() < geometry::kLargestCoordinate_m).all();
}

bool is_usable(const Triangle& triangle) {
  return is_usable(triangle[0]) && is_usable(triangle[1]) && is_usable(triangle[2]);
}

bool is_usable(std::span<const Triangle> body) {
  return std::all_of(body.begin(), body.end(), [](const Triangle& t) { return is_usable(t); });
}

Box bounds_of(std::span<const Triangle> body) {
  Box box;
  for (const Triangle& triangle : body) box.extend(geometry::bounds(triangle));
  return box;
}

/// For the walk: a search among the triangles near a body.
template <class Search>
class WalkedBy : public Search {
 public:
  using Search::Search;

  static bool enters(const IndexNode&, std::size_t) { return true; }

  void leaf(const IndexWalk::Leaf& leaf) {
    leaf.for_each(*this, [this](std::uint32_t triangle) {
      this->consider(triangle);
      return !this->is_done();
    });
    this->settle();
  }
};

/// For the walk: leaves that a triangle touches.
template <class Visit>
class TouchQuery {
 public:
  TouchQuery(const Triangle& triangle, const Visit& visit)
      : triangle_(triangle), sides_(geometry::bounds(triangle)), visit_(visit) {}

  [[nodiscard]] const BoxSides& sides() const { return sides_; }
  static const ObliqueSides* oblique() { return nullptr; }
  static double squared_reach_m2() { return 0.0; }
  static bool is_beyond(double) { return false; }
  [[nodiscard]] bool is_done() const { return is_done_; }

  /// The box of a long triangle meets far more than the triangle.
  [[nodiscard]] bool enters(const IndexNode& node, std::size_t slot) const {
    return geometry::triangle_touches_box(triangle_, node.frame.box_of(get_box(node.boxes, slot)));
  }

  void leaf(const IndexWalk::Leaf& leaf) { is_done_ = !visit_(*this, leaf); }

 private:
  const Triangle& triangle_;
  BoxSides sides_;
  const Visit& visit_;
  bool is_done_ = false;
};

/// Calls `visit(query, leaf)` for every leaf that `triangle` touches until it returns false.
template <class Visit>
void visit_leaves(const SceneIndex& index, const Triangle& triangle, const Visit& visit) {
  TouchQuery<Visit> query(triangle, visit);
  IndexWalk(index).run(query);
}

/// For the walk: everything that meets a box.
class BoxQuery {
 public:
  BoxQuery(const Box& box, const Mesh& mesh, bool (*visit)(void*, std::uint32_t), void* context)
      : box_(box), sides_(box), mesh_(mesh), visit_(visit), context_(context) {}

  [[nodiscard]] const BoxSides& sides() const { return sides_; }
  static const ObliqueSides* oblique() { return nullptr; }
  static double squared_reach_m2() { return 0.0; }
  static bool is_beyond(double) { return false; }
  static bool enters(const IndexNode&, std::size_t) { return true; }
  [[nodiscard]] bool is_done() const { return is_done_; }

  void leaf(const IndexWalk::Leaf& leaf) {
    leaf.for_each(*this, [this](std::uint32_t triangle) {
      is_done_ = !is_apart(triangle) && !visit_(context_, triangle);
      return !is_done_;
    });
  }

 private:
  /// False for NaN.
  [[nodiscard]] bool is_apart(std::uint32_t triangle) const {
    const Box other = geometry::bounds(mesh_.triangle(triangle));
    return (other.min().array() > box_.max().array()).any() ||
           (other.max().array() < box_.min().array()).any();
  }

  const Box& box_;
  BoxSides sides_;
  const Mesh& mesh_;
  bool (*visit_)(void*, std::uint32_t);
  void* context_;
  bool is_done_ = false;
};

std::optional<Nearest> search(const SceneIndex& index, const Mesh& mesh,
                              std::span<const Triangle> body, double cutoff_m,
                              DistanceSearch::Goal goal, double certain_m = 0.0,
                              double share = 1.0) {
  if (!is_usable(body) || std::isnan(cutoff_m)) return Nearest{0.0, 0};
  const Box body_box = bounds_of(body);
  const Box all = body_box.merged(index.bounds());
  WalkedBy<DistanceSearch> query(body, body_box, mesh, cutoff_m,
                                 geometry::triangle_distance_error_m(all.sizes().maxCoeff()), goal,
                                 certain_m, share);
  IndexWalk(index).run(query);
  return query.result();
}

}  // namespace

std::span<const std::uint32_t> SceneIndex::leaf_triangles(std::uint32_t leaf) const {
  return std::span(references_)
      .subspan(leaf_begin_[leaf], leaf_begin_[leaf + 1] - leaf_begin_[leaf]);
}

std::optional<std::uint32_t> SceneIndex::first_intersection(const Triangle& triangle) const {
  if (size() == 0) return std::nullopt;
  if (!is_usable(triangle)) return 0;
  std::uint32_t lowest = kNone;
  visit_leaves(*this, triangle, [&](const auto& query, const IndexWalk::Leaf& leaf) {
    leaf.for_each(query, [&](std::uint32_t index) {
      if (index < lowest && geometry::triangles_touch(triangle, mesh_->triangle(index))) {
        lowest = index;
      }
      return index < lowest;
    });
    return lowest != 0;
  });
  if (lowest == kNone) return std::nullopt;
  return lowest;
}

bool SceneIndex::intersects(const Triangle& triangle) const {
  if (size() == 0) return false;
  if (!is_usable(triangle)) return true;
  bool found = false;
  visit_leaves(*this, triangle, [&](const auto& query, const IndexWalk::Leaf& leaf) {
    leaf.for_each(query, [&](std::uint32_t index) {
      found = geometry::triangles_touch(triangle, mesh_->triangle(index));
      return !found;
    });
    return !found;
  });
  return found;
}

std::optional<SegmentHit> SceneIndex::closest_hit(const LineSegment& segment) const {
  if (size() == 0) return std::nullopt;
  if (!is_usable(segment.from) || !is_usable(segment.to)) return SegmentHit{0.0, 0};
  std::optional<SegmentHit> best;
  const Triangle thin = {segment.from, segment.to, segment.to};
  visit_leaves(*this, thin, [&](const auto& query, const IndexWalk::Leaf& leaf) {
    leaf.for_each(query, [&](std::uint32_t index) {
      const auto fraction = geometry::hit_fraction(segment, mesh_->triangle(index));
      if (fraction && (!best || *fraction < best->fraction ||
                       (*fraction == best->fraction && index < best->triangle))) {
        best = SegmentHit{*fraction, index};
      }
      return true;
    });
    return true;
  });
  return best;
}

void SceneIndex::leaves_touching(const Triangle& triangle, std::vector<std::uint32_t>& out) const {
  out.clear();
  visit_leaves(*this, triangle, [&](const auto&, const IndexWalk::Leaf& leaf) {
    out.push_back(leaf.id());
    return true;
  });
  std::sort(out.begin(), out.end());
}

double SceneIndex::nearest_error_m(std::span<const Triangle> body) const {
  if (body.empty() || size() == 0) return 0.0;
  const Box all = bounds_of(body).merged(bounds_);
  return geometry::triangle_distance_error_m(all.sizes().maxCoeff());
}

std::optional<Nearest> SceneIndex::nearest(std::span<const Triangle> body, double cutoff_m) const {
  if (size() == 0 || body.empty()) return std::nullopt;
  return search(*this, *mesh_, body, cutoff_m, DistanceSearch::Goal::kNearest);
}

std::optional<Nearest> SceneIndex::near(std::span<const Triangle> body, double cutoff_m,
                                        double certain_m, double share) const {
  if (size() == 0 || body.empty()) return std::nullopt;
  return search(*this, *mesh_, body, cutoff_m, DistanceSearch::Goal::kNear, certain_m, share);
}

Passage SceneIndex::passage(const MovingBody& body) const {
  if (size() == 0 || body.middle.empty()) {
    return {true, std::nullopt, std::numeric_limits<double>::infinity()};
  }
  if (!is_usable(body.middle) || !is_usable(body.ends)) return {false, Nearest{0.0, 0}, 0.0};
  const Box ends_box = bounds_of(body.ends);
  WalkedBy<PassageSearch> query(body, ends_box, *mesh_, nearest_error_m(body.ends));
  IndexWalk(*this).run(query);
  return query.passage();
}

std::optional<Nearest> SceneIndex::any_within(std::span<const Triangle> body,
                                              double distance_m) const {
  if (size() == 0 || body.empty()) return std::nullopt;
  return search(*this, *mesh_, body, distance_m, DistanceSearch::Goal::kAny);
}

bool SceneIndex::visit_touching(const Box& box, bool (*visit)(void*, std::uint32_t),
                                void* context) const {
  if (size() == 0) return true;
  BoxQuery query(box, *mesh_, visit, context);
  IndexWalk(*this).run(query);
  return !query.is_done();
}

}  // namespace camway::scene
