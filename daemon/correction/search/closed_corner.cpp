// SPDX-License-Identifier: MIT
#include "daemon/correction/search/closed_corner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "daemon/geometry/bounds.h"
#include "daemon/geometry/triangle_box.h"
#include "daemon/scene/index/scene_index.h"

namespace camway::correction {

namespace {

using geometry::Box;
using geometry::LineSegment;
using geometry::Triangle;
using geometry::Vec3;

constexpr std::size_t kMostTriangles = 24;
constexpr double kParallel = 0.966;  // cosine between normals, of 15 degrees
constexpr double kRounding = 1e-6;   // of the box

/// The part of a segment that is left when half-spaces are cut off.
class Part {
 public:
  explicit Part(const LineSegment& whole) : whole_(whole) {}

  /// Keeps where `normal` · x >= `least`.
  void keep(const Vec3& normal, double least) {
    const double at_begin = normal.dot(whole_.from) - least;
    const double at_end = normal.dot(whole_.to) - least;
    if (at_begin < 0.0 && at_end < 0.0) end_ = -1.0;
    if (at_begin < 0.0 && at_end >= 0.0) begin_ = std::max(begin_, at_begin / (at_begin - at_end));
    if (at_begin >= 0.0 && at_end < 0.0) end_ = std::min(end_, at_begin / (at_begin - at_end));
  }
  void keep(const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
      keep(Vec3::Unit(axis), box.min()[axis]);
      keep(-Vec3::Unit(axis), -box.max()[axis]);
    }
  }
  [[nodiscard]] std::optional<LineSegment> rest() const {
    if (begin_ > end_) return std::nullopt;
    const Vec3 along = whole_.to - whole_.from;
    return LineSegment{whole_.from + begin_ * along, whole_.from + end_ * along};
  }

 private:
  const LineSegment& whole_;
  double begin_ = 0.0;
  double end_ = 1.0;
};

class Corner {
 public:
  Corner(const collision::Obstacles& obstacles, const Box& box, const Vec3& from_W, double keep_m)
      : box_(box),
        from_W_(from_W),
        keep_m_(keep_m),
        rounding_m_(kRounding * box.sizes().maxCoeff()),
        is_known_(collect(obstacles.index) && add_sides(obstacles.bounds)) {}

  [[nodiscard]] std::optional<ClosedCorner> closed() {
    if (!is_known_ || !find_walls() || corner_.count == 0) return std::nullopt;
    for (std::size_t wall = 0; wall < corner_.count; ++wall) {
      for (std::size_t i = 0; i < count_; ++i) {
        if (is_in(wall, i) && !is_closed_at_edges(wall, i)) return std::nullopt;
      }
    }
    return corner_;
  }

 private:
  /// False if there are too many.
  bool collect(const scene::SceneIndex& index) {
    std::array<std::uint32_t, kMostTriangles> met{};
    return index.for_each_touching(box_, [&](std::uint32_t t) {
      const auto end = met.begin() + static_cast<std::ptrdiff_t>(count_);
      const Triangle triangle = index.triangle(t);
      if (std::find(met.begin(), end, t) != end || !geometry::triangle_touches_box(triangle, box_))
        return true;
      if (count_ == kMostTriangles) return false;
      met[count_] = t;
      normals_[count_] =
          (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).stableNormalized();
      triangles_[count_++] = triangle;
      return true;
    });
  }

  /// The sides of the bounds that cut the box are walls; nothing beyond them can be reached. False
  /// if they make no corner.
  bool add_sides(const geometry::Bounds& bounds) {
    for (std::size_t side = 0; side < geometry::Bounds::kSides; ++side) {
      const Vec3 inward = geometry::Bounds::inward(side);
      const Vec3& outermost = side < 3 ? box_.min() : box_.max();
      if (bounds.depth_m(side, outermost) >= 0.0) continue;
      if (bounds.depth_m(side, from_W_) <= 0.0) return false;
      if (!add_wall({inward, inward.sum() * bounds.limit_m(side)})) return false;
    }
    return true;
  }

  bool add_wall(Wall wall) {
    const double height_m = wall.height_m(from_W_);
    if (corner_.count == ClosedCorner::kMostWalls || std::abs(height_m) <= keep_m_) return false;
    if (height_m < 0.0) wall = {-wall.normal, -wall.at_m};
    for (std::size_t i = 0; i < corner_.count; ++i) {
      if (std::abs(corner_.walls[i].normal.dot(wall.normal)) > kParallel) return false;
    }
    corner_.walls[corner_.count++] = wall;
    return true;
  }

  /// Adds walls, each in the plane of the nearest triangle that is in front of all walls so far.
  /// Returns false if there are too many, or if they make no corner.
  bool find_walls() {
    while (const std::optional<std::size_t> next = nearest_in_front()) {
      if (!add_wall({normals_[*next], normals_[*next].dot(triangles_[*next][0])})) return false;
    }
    return true;
  }

  [[nodiscard]] std::optional<std::size_t> nearest_in_front() const {
    std::optional<std::size_t> nearest;
    double least_m = 0.0;
    for (std::size_t i = 0; i < count_; ++i) {
      if (is_behind_any(i)) continue;
      const double distance_m = distance_to(i, from_W_);
      if (nearest && distance_m >= least_m) continue;
      nearest = i;
      least_m = distance_m;
    }
    return nearest;
  }

  [[nodiscard]] bool is_behind_any(std::size_t triangle) const {
    for (std::size_t wall = 0; wall < corner_.count; ++wall) {
      if (highest_m(wall, triangle) <= keep_m_) return true;
    }
    return false;
  }

  [[nodiscard]] double highest_m(std::size_t wall, std::size_t triangle) const {
    const Triangle& t = triangles_[triangle];
    const Vec3& normal = corner_.walls[wall].normal;
    return std::max({normal.dot(t[0]), normal.dot(t[1]), normal.dot(t[2])}) -
           corner_.walls[wall].at_m;
  }

  /// Whether the triangle belongs to the wall: the ball does not fit between things less than
  /// `keep_m` apart.
  [[nodiscard]] bool is_in(std::size_t wall, std::size_t triangle) const {
    return std::ranges::all_of(triangles_[triangle], [&](const Vec3& vertex) {
      return std::abs(corner_.walls[wall].height_m(vertex)) <= keep_m_;
    });
  }

  [[nodiscard]] double distance_to(std::size_t triangle, const Vec3& point) const {
    const Triangle& t = triangles_[triangle];
    const Vec3& normal = normals_[triangle];
    double least_m = std::numeric_limits<double>::infinity();
    // Whether the point is above the inside of the triangle; one without area has none.
    bool is_over = !normal.isZero(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 along = t[(k + 1) % 3] - t[k];
      const Vec3 to = point - t[k];
      const double share = std::clamp(along.dot(to) / along.squaredNorm(), 0.0, 1.0);
      least_m = std::min(least_m, (to - share * along).norm());
      is_over = is_over && normal.dot(along.cross(to)) >= 0.0;
    }
    return is_over ? std::abs(normal.dot(point - t[0])) : least_m;
  }

  [[nodiscard]] bool is_closed_at_edges(std::size_t wall, std::size_t triangle) const {
    const Triangle& t = triangles_[triangle];
    for (std::size_t k = 0; k < 3; ++k) {
      const LineSegment edge{t[k], t[(k + 1) % 3]};
      Part part(edge);
      part.keep(box_);
      for (std::size_t other = 0; other < corner_.count; ++other) {
        if (other != wall)
          part.keep(corner_.walls[other].normal, corner_.walls[other].at_m - keep_m_);
      }
      const std::optional<LineSegment> rest = part.rest();
      if (rest && !is_joined(wall, triangle, *rest, t[(k + 2) % 3])) return false;
    }
    return true;
  }

  /// Whether another triangle stays within `keep_m` of the whole edge and continues the wall beyond
  /// it. Its distance at both ends suffices, as distance from a triangle is convex. Copies of the
  /// same triangle do not count; surfaces often occur twice.
  [[nodiscard]] bool is_joined(std::size_t wall, std::size_t triangle, const LineSegment& edge,
                               const Vec3& third) const {
    const Vec3 outward = outward_of(triangle, third);
    for (std::size_t other = 0; other < count_; ++other) {
      if (other == triangle || distance_to(other, edge.from) > keep_m_ ||
          distance_to(other, edge.to) > keep_m_)
        continue;
      if (!is_in(wall, other)) {
        if (is_in_another(wall, other)) return true;
        continue;
      }
      const bool goes_on = std::ranges::any_of(triangles_[other], [&](const Vec3& vertex) {
        return outward.dot(vertex - edge.from) > rounding_m_;
      });
      if (goes_on) return true;
    }
    return false;
  }

  [[nodiscard]] bool is_in_another(std::size_t wall, std::size_t triangle) const {
    for (std::size_t other = 0; other < corner_.count; ++other) {
      if (other != wall && is_in(other, triangle)) return true;
    }
    return false;
  }

  /// In the plane of the triangle, across the edge that is opposite to a vertex.
  [[nodiscard]] Vec3 outward_of(std::size_t triangle, const Vec3& third) const {
    const Triangle& t = triangles_[triangle];
    const auto k = static_cast<std::size_t>(std::ranges::find(t, third) - t.begin());
    const Vec3& a = t[(k + 1) % 3];
    const Vec3 along = (t[(k + 2) % 3] - a).stableNormalized();
    const Vec3 from_edge = third - a;
    return (along.dot(from_edge) * along - from_edge).stableNormalized();
  }

  const Box& box_;
  const Vec3& from_W_;
  const double keep_m_;
  const double rounding_m_;
  std::size_t count_ = 0;
  std::array<Triangle, kMostTriangles> triangles_;
  std::array<Vec3, kMostTriangles> normals_;
  ClosedCorner corner_;
  bool is_known_;
};

}  // namespace

std::optional<ClosedCorner> closed_corner(const collision::Obstacles& obstacles, const Box& box,
                                          const Vec3& from_W, double keep_m) {
  return Corner(obstacles, box, from_W, keep_m).closed();
}

}  // namespace camway::correction
