// SPDX-License-Identifier: MIT
#include "daemon/scene/import/readers/polygon_holes.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "daemon/scene/import/readers/polygon_cutter.h"

namespace camway::scene::mesh_readers {
namespace {

using Point2 = std::array<double, 2>;
using Index = std::uint32_t;
using Ring = std::vector<Index>;

/// Whether `p`, on the line through `a` and `b`, is between them or one of them.
bool is_between(const Point2& p, const Point2& a, const Point2& b) {
  return std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) &&
         std::min(a[1], b[1]) <= p[1] && p[1] <= std::max(a[1], b[1]);
}

bool is_on_segment(const Point2& p, const Point2& a, const Point2& b) {
  return orientation(a, b, p) == 0.0 && is_between(p, a, b);
}

int sign_of(double turn) { return turn > 0.0 ? 1 : (turn < 0.0 ? -1 : 0); }

/// Whether a bridge from `a` to `b` meets an edge anywhere but at a common end.
bool is_blocked(const Point2& a, const Point2& b, const Point2& from, const Point2& to) {
  const bool shares_from = from == a || from == b;
  const bool shares_to = to == a || to == b;
  if (shares_from && shares_to) return true;
  if (shares_from || shares_to) {
    const Point2& other = shares_from ? to : from;
    const Point2& far_end = (shares_from ? from : to) == a ? b : a;
    return is_on_segment(other, a, b) || is_on_segment(far_end, from, to);
  }
  const int from_side = sign_of(orientation(a, b, from));
  const int to_side = sign_of(orientation(a, b, to));
  const int a_side = sign_of(orientation(from, to, a));
  const int b_side = sign_of(orientation(from, to, b));
  if (from_side * to_side < 0 && a_side * b_side < 0) return true;
  return (from_side == 0 && is_between(from, a, b)) || (to_side == 0 && is_between(to, a, b)) ||
         (a_side == 0 && is_between(a, from, to)) || (b_side == 0 && is_between(b, from, to));
}

class HoleJoiner {
 public:
  explicit HoleJoiner(std::span<const Point2> points) : points_(points) {}

  /// Returns false if the outline has no area.
  bool set_outline(std::size_t corners) {
    ring_ = indices(0, corners);
    return ring_.size() >= 3;
  }

  /// Returns false if the hole has no area.
  bool add_hole(std::size_t begin, std::size_t end) {
    Ring hole = indices(begin, end);
    if (hole.size() < 3) return false;
    // The corner at the right end is convex, so its turn is that of the hole.
    // Not std::ranges::rotate: Clang 14 cannot compile that of GCC 12's library.
    const auto right_end =
        std::ranges::max_element(hole, {}, [&](Index corner) { return points_[corner]; });
    std::rotate(hole.begin(), right_end, hole.end());
    const double turn = orientation(points_[hole.back()], points_[hole[0]], points_[hole[1]]);
    if (turn == 0.0) return false;
    if (turn > 0.0) std::reverse(hole.begin() + 1, hole.end());
    holes_.push_back(std::move(hole));
    return true;
  }

  Ring join() {
    // Then nothing but the ring is to the right of the hole that is next.
    std::ranges::stable_sort(
        holes_, [&](const Ring& a, const Ring& b) { return points_[a[0]] > points_[b[0]]; });
    for (next_ = 0; next_ < holes_.size(); ++next_) {
      const std::optional<std::size_t> at = find_bridge(holes_[next_]);
      if (!at) return {};
      insert(holes_[next_], *at);
    }
    return std::move(ring_);
  }

 private:
  /// Without corners at the place of the one before, whose edges have no direction.
  [[nodiscard]] Ring indices(std::size_t begin, std::size_t end) const {
    Ring list;
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t before = i == begin ? end - 1 : i - 1;
      if (points_[i] != points_[before]) list.push_back(static_cast<Index>(i));
    }
    return list;
  }

  /// The place in the ring that a bridge leads to from the first corner of the hole: the nearest
  /// one that can be seen from it.
  [[nodiscard]] std::optional<std::size_t> find_bridge(const Ring& hole) const {
    const Point2& start = points_[hole[0]];
    std::vector<std::pair<double, std::size_t>> places;
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const double x = points_[ring_[i]][0] - start[0];
      const double y = points_[ring_[i]][1] - start[1];
      places.emplace_back(x * x + y * y, i);
    }
    std::ranges::sort(places);
    for (const auto& [distance, place] : places) {
      const Point2& end = points_[ring_[place]];
      if (is_inside(ring_, place, start) && is_inside(hole, 0, end) && is_free(start, end)) {
        return place;
      }
    }
    return std::nullopt;
  }

  /// Whether the way from a corner towards `target` begins inside, which is to the left.
  [[nodiscard]] bool is_inside(const Ring& ring, std::size_t at, const Point2& target) const {
    const Point2& before = points_[ring[at == 0 ? ring.size() - 1 : at - 1]];
    const Point2& corner = points_[ring[at]];
    const Point2& after = points_[ring[at + 1 == ring.size() ? 0 : at + 1]];
    if (target == corner) return false;
    const bool left_of_first = orientation(before, corner, target) > 0.0;
    const bool left_of_second = orientation(corner, after, target) > 0.0;
    return orientation(before, corner, after) > 0.0 ? left_of_first && left_of_second
                                                    : left_of_first || left_of_second;
  }

  [[nodiscard]] bool is_free(const Point2& a, const Point2& b) const {
    if (blocks(ring_, a, b)) return false;
    return std::none_of(holes_.begin() + static_cast<std::ptrdiff_t>(next_), holes_.end(),
                        [&](const Ring& hole) { return blocks(hole, a, b); });
  }

  [[nodiscard]] bool blocks(const Ring& ring, const Point2& a, const Point2& b) const {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Index to = ring[i + 1 == ring.size() ? 0 : i + 1];
      if (is_blocked(a, b, points_[ring[i]], points_[to])) return true;
    }
    return false;
  }

  void insert(const Ring& hole, std::size_t place) {
    Ring detour(hole);
    detour.push_back(hole[0]);
    detour.push_back(ring_[place]);
    ring_.insert(ring_.begin() + static_cast<std::ptrdiff_t>(place) + 1, detour.begin(),
                 detour.end());
  }

  std::span<const Point2> points_;
  Ring ring_;
  std::vector<Ring> holes_;  ///< clockwise, from the corner at the right end
  std::size_t next_ = 0;     ///< holes from here on are not in the ring yet
};

}  // namespace

std::vector<std::uint32_t> ring_with_holes(std::span<const Point2> points,
                                           std::span<const std::size_t> ends) {
  HoleJoiner joiner(points);
  if (!joiner.set_outline(ends[0])) return {};
  for (std::size_t i = 1; i < ends.size(); ++i) {
    if (!joiner.add_hole(ends[i - 1], ends[i])) return {};
  }
  return joiner.join();
}

}  // namespace camway::scene::mesh_readers
