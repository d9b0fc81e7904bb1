// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <limits>

#include "daemon/geometry/segment_triangle.h"
#include "daemon/geometry/triangle_box.h"
#include "daemon/geometry/triangle_distance.h"
#include "daemon/geometry/triangle_intersection.h"
#include "daemon/scene/scene_index.h"

namespace camway::scene {

using geometry::Box;
using geometry::LineSegment;
using geometry::Triangle;

namespace {

/// Depth first, each level leaves at most seven siblings waiting.
constexpr std::size_t kStackSize = 7 * kMaxIndexDepth + 8;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

Box bounds_of(std::span<const Triangle> body) {
  Box box;
  for (const Triangle& triangle : body) box.extend(geometry::bounds(triangle));
  return box;
}

/// What can still be nearer than the best so far, given the rounding of distances.
class Horizon {
 public:
  Horizon(double cutoff_m, double error_m) : error_m_(error_m) { shrink_to(cutoff_m); }

  void shrink_to(double best_m) {
    // 1e-14 covers the relative error of a squared box distance (8u) and of this square.
    const double reach_m = best_m + 2.0 * error_m_;
    squared_m2_ = reach_m * reach_m * (1.0 + 1e-14);
  }
  [[nodiscard]] bool is_beyond(double squared_distance_m2) const {
    return squared_distance_m2 > squared_m2_;
  }

 private:
  double error_m_;
  double squared_m2_ = 0.0;
};

/// Remembers which triangles were asked already: a triangle is met once per leaf that it lies in,
/// and its distance does not change. Forgetting one costs time only.
class Asked {
 public:
  Asked() { slots_.fill(kNone); }

  /// Whether `index` was surely met before; remembers it in any case.
  bool before(std::uint32_t index) {
    std::uint32_t& slot = slots_[index % slots_.size()];
    if (slot == index) return true;
    slot = index;
    return false;
  }

 private:
  std::array<std::uint32_t, 256> slots_;
};

/// The nearest triangle so far, and what can still be nearer.
class NearestSearch {
 public:
  NearestSearch(std::span<const Triangle> body, std::span<const Triangle> scene, double cutoff_m,
                double error_m)
      : body_(body), scene_(scene), body_box_(bounds_of(body)), horizon_(cutoff_m, error_m) {
    best_.distance_m = cutoff_m;
    best_.triangle = kNone;
  }

  [[nodiscard]] double squared_distance_m2(const Box& box) const {
    return geometry::squared_box_distance_m2(body_box_, box);
  }
  [[nodiscard]] bool is_beyond(double squared_m2) const { return horizon_.is_beyond(squared_m2); }
  [[nodiscard]] const Nearest& best() const { return best_; }

  void ask(std::uint32_t index) {
    // Nothing is nearer than a touch, so only a lower index could still win.
    if (best_.distance_m == 0.0 && index >= best_.triangle) return;
    const Triangle& triangle = scene_[index];
    const Box box = geometry::bounds(triangle);
    if (is_beyond(squared_distance_m2(box)) || asked_.before(index)) return;
    for (const Triangle& part : body_) {
      if (body_.size() > 1 &&
          is_beyond(geometry::squared_box_distance_m2(geometry::bounds(part), box))) {
        continue;
      }
      const double distance_m = geometry::triangle_distance(part, triangle);
      const bool tie = distance_m == best_.distance_m && best_.triangle != kNone;
      if (distance_m < best_.distance_m || (tie && index < best_.triangle)) {
        best_ = {distance_m, index};
        horizon_.shrink_to(distance_m);
      }
    }
  }

 private:
  std::span<const Triangle> body_;
  std::span<const Triangle> scene_;
  Box body_box_;
  Horizon horizon_;
  Asked asked_;
  Nearest best_;
};

struct Waiting {
  double squared_m2;
  std::uint32_t node;
};

}  // namespace

std::span<const std::uint32_t> SceneIndex::leaf_triangles(std::uint32_t leaf) const {
  return std::span(references_)
      .subspan(leaf_begin_[leaf], leaf_begin_[leaf + 1] - leaf_begin_[leaf]);
}

template <class Visit>
void SceneIndex::visit_leaves(const Triangle& triangle, const Visit& visit) const {
  if (nodes_.empty()) return;
  const Box box = geometry::bounds(triangle);
  std::array<std::uint32_t, kStackSize> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    if (!node.box.intersects(box) || !geometry::triangle_touches_box(triangle, node.box)) continue;
    if (node.count == 0) {
      if (!visit(node.first)) return;
      continue;
    }
    for (std::uint32_t i = node.count; i-- > 0;) stack[size++] = node.first + i;
  }
}

std::optional<std::uint32_t> SceneIndex::first_intersection(const Triangle& triangle) const {
  std::uint32_t lowest = kNone;
  visit_leaves(triangle, [&](std::uint32_t leaf) {
    for (const std::uint32_t index : leaf_triangles(leaf)) {
      if (index >= lowest) break;
      if (geometry::triangles_touch(triangle, triangles_[index])) lowest = index;
    }
    return lowest != 0;
  });
  if (lowest == kNone) return std::nullopt;
  return lowest;
}

bool SceneIndex::intersects(const Triangle& triangle) const {
  bool found = false;
  visit_leaves(triangle, [&](std::uint32_t leaf) {
    for (const std::uint32_t index : leaf_triangles(leaf)) {
      if (geometry::triangles_touch(triangle, triangles_[index])) {
        found = true;
        return false;
      }
    }
    return true;
  });
  return found;
}

std::optional<SegmentHit> SceneIndex::closest_hit(const LineSegment& segment) const {
  std::optional<SegmentHit> best;
  visit_leaves({segment.from, segment.to, segment.to}, [&](std::uint32_t leaf) {
    for (const std::uint32_t index : leaf_triangles(leaf)) {
      const std::optional<double> fraction = geometry::hit_fraction(segment, triangles_[index]);
      if (!fraction) continue;
      if (!best || *fraction < best->fraction ||
          (*fraction == best->fraction && index < best->triangle)) {
        best = SegmentHit{*fraction, index};
      }
    }
    return true;
  });
  return best;
}

void SceneIndex::leaves_touching(const Triangle& triangle, std::vector<std::uint32_t>& out) const {
  out.clear();
  visit_leaves(triangle, [&](std::uint32_t leaf) {
    out.push_back(leaf);
    return true;
  });
}

double SceneIndex::nearest_error_m(std::span<const Triangle> body) const {
  if (body.empty() || triangles_.empty()) return 0.0;
  const Box all = bounds_of(body).merged(bounds_);
  return geometry::triangle_distance_error_m(all.sizes().maxCoeff());
}

template <class Stop>
std::optional<Nearest> SceneIndex::search(std::span<const Triangle> body, double cutoff_m,
                                          const Stop& stop) const {
  if (nodes_.empty() || body.empty()) return std::nullopt;
  NearestSearch search(body, triangles_, cutoff_m, nearest_error_m(body));
  std::array<Waiting, kStackSize> stack;
  std::size_t size = 0;
  stack[size++] = {search.squared_distance_m2(nodes_[0].box), 0};
  while (size > 0) {
    const Waiting top = stack[--size];
    if (search.is_beyond(top.squared_m2)) continue;
    const Node& node = nodes_[top.node];
    if (node.count == 0) {
      for (const std::uint32_t index : leaf_triangles(node.first)) {
        search.ask(index);
        if (stop(search.best())) return search.best();
      }
      continue;
    }
    const std::size_t begin = size;
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const double squared_m2 = search.squared_distance_m2(nodes_[node.first + i].box);
      if (!search.is_beyond(squared_m2)) stack[size++] = {squared_m2, node.first + i};
    }
    // The closest child on top, so that the horizon shrinks early.
    std::sort(stack.data() + begin, stack.data() + size, [](const Waiting& a, const Waiting& b) {
      return a.squared_m2 > b.squared_m2 || (a.squared_m2 == b.squared_m2 && a.node > b.node);
    });
  }
  if (search.best().triangle == kNone) return std::nullopt;
  return search.best();
}

std::optional<Nearest> SceneIndex::nearest(std::span<const Triangle> body, double cutoff_m) const {
  return search(body, cutoff_m, [](const Nearest&) { return false; });
}

std::optional<Nearest> SceneIndex::any_within(std::span<const Triangle> body,
                                              double distance_m) const {
  return search(body, distance_m, [](const Nearest& best) { return best.triangle != kNone; });
}

bool SceneIndex::visit_touching(const Box& box, bool (*visit)(void*, std::uint32_t),
                                void* context) const {
  if (nodes_.empty()) return true;
  std::array<std::uint32_t, kStackSize> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    if (!node.box.intersects(box)) continue;
    for (std::uint32_t i = node.count; i-- > 0;) stack[size++] = node.first + i;
    if (node.count > 0) continue;
    for (const std::uint32_t index : leaf_triangles(node.first)) {
      if (geometry::bounds(triangles_[index]).intersects(box) && !visit(context, index)) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace camway::scene
