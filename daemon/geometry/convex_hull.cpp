// SPDX-License-Identifier: MIT
#include "daemon/geometry/convex_hull.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "daemon/geometry/exact_points.h"
#include "daemon/geometry/rounding.h"

namespace camway::geometry {
namespace {

using Index = std::uint32_t;
using Indices = std::array<Index, 3>;
using Edge = std::pair<Index, Index>;

std::array<Edge, 3> edges_of(const Indices& v) {
  return {Edge{v[0], v[1]}, Edge{v[1], v[2]}, Edge{v[2], v[0]}};
}

Edge reversed(const Edge& edge) { return {edge.second, edge.first}; }

/// A surface of triangles that encloses all points seen so far and grows by the others.
class Quickhull {
 public:
  Quickhull(const ExactPoints& points, const std::array<Index, 4>& simplex) : points_(points) {
    auto [a, b, c, d] = simplex;
    if (points_.side(a, b, c, d) > 0) std::swap(b, c);
    for (const Indices& v :
         {Indices{a, b, c}, Indices{b, a, d}, Indices{c, b, d}, Indices{a, c, d}})
      add_face(v);
    std::vector<Index> all(points_.size());
    std::iota(all.begin(), all.end(), Index{0});
    distribute(all, 0);
    // Points move only to faces with higher numbers.
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (!faces_[f].outside.empty()) extend(static_cast<Index>(f));
    }
  }

  [[nodiscard]] std::vector<Indices> triangles() const {
    std::vector<Indices> triangles;
    for (const Face& face : faces_) {
      if (face.alive) triangles.push_back(face.v);
    }
    return triangles;
  }

  /// One triangle for each plane of the surface.
  [[nodiscard]] std::vector<Indices> planes() const {
    std::vector<Indices> planes;
    std::vector<bool> known(faces_.size(), false);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (!faces_[f].alive || known[f]) continue;
      planes.push_back(faces_[f].v);
      for (const Index g : connected(static_cast<Index>(f), [&](const Indices& v) {
             return std::ranges::all_of(v, [&](Index i) { return side(faces_[f].v, i) == 0; });
           }))
        known[g] = true;
    }
    return planes;
  }

 private:
  struct Face {
    Indices v;
    std::vector<Index> outside;  ///< points above it that are not on the surface yet
    bool alive = true;
  };

  [[nodiscard]] int side(const Indices& v, Index point) const {
    return points_.side(v[0], v[1], v[2], point);
  }

  void add_face(const Indices& v) {
    for (const Edge& edge : edges_of(v)) face_of_edge_[edge] = static_cast<Index>(faces_.size());
    faces_.push_back({v, {}, true});
  }

  /// `start` and all faces connected to it through faces for which `belongs` is true.
  template <class Belongs>
  [[nodiscard]] std::vector<Index> connected(Index start, const Belongs& belongs) const {
    std::vector<bool> known(faces_.size(), false);
    std::vector<Index> found{start};
    known[start] = true;
    for (std::size_t i = 0; i < found.size(); ++i) {
      for (const Edge& edge : edges_of(faces_[found[i]].v)) {
        const Index next = face_of_edge_.at(reversed(edge));
        if (known[next]) continue;
        known[next] = true;
        if (belongs(faces_[next].v)) found.push_back(next);
      }
    }
    return found;
  }

  /// Assigns each point to the first face from `first` on that it is above; points above none are
  /// inside. No point is lost: a point above a removed face is above one of the faces that replace
  /// it, or inside. For the line to it from the middle of the removed face leaves the new hull
  /// above that face's plane, where no old face is.
  void distribute(const std::vector<Index>& points, std::size_t first) {
    for (const Index point : points) {
      for (std::size_t f = first; f < faces_.size(); ++f) {
        if (side(faces_[f].v, point) <= 0) continue;
        faces_[f].outside.push_back(point);
        break;
      }
    }
  }

  /// Any of the points is correct; the farthest makes the hull large early.
  [[nodiscard]] Index farthest(const Face& face) const {
    const Vec3& a = points_[face.v[0]];
    const Vec3 normal = (points_[face.v[1]] - a).cross(points_[face.v[2]] - a);
    return *std::ranges::max_element(face.outside, {},
                                     [&](Index point) { return normal.dot(points_[point] - a); });
  }

  /// Adds one point outside of a face to the hull.
  void extend(Index face) {
    const Index eye = farthest(faces_[face]);
    const std::vector<Index> visible =
        connected(face, [&](const Indices& v) { return side(v, eye) > 0; });
    std::vector<Index> orphans;
    for (const Index f : visible) {
      faces_[f].alive = false;
      std::ranges::remove_copy(faces_[f].outside, std::back_inserter(orphans), eye);
      faces_[f].outside.clear();
    }
    std::vector<Edge> horizon;
    for (const Index f : visible) {
      for (const Edge& edge : edges_of(faces_[f].v)) {
        if (faces_[face_of_edge_.at(reversed(edge))].alive) horizon.push_back(edge);
      }
    }
    for (const Index f : visible) {
      for (const Edge& edge : edges_of(faces_[f].v)) face_of_edge_.erase(edge);
    }
    const std::size_t first = faces_.size();
    for (const Edge& edge : horizon) add_face({edge.first, edge.second, eye});
    distribute(orphans, first);
  }

  const ExactPoints& points_;
  std::vector<Face> faces_;
  std::map<Edge, Index> face_of_edge_;
};

/// The half-space below a face, with its offset rounded up until it holds all points.
HalfSpace half_space(const ExactPoints& points, const Indices& v) {
  // A scalar product has 3 roundings in sequence, relative to the product of lengths at most; the
  // fourth is that of the sum below, and the rest is for second order.
  constexpr double kRounding = 5.0 * geometry::kUnitRoundoff;
  HalfSpace face{points.unit_normal(v[0], v[1], v[2]), 0.0};
  double highest = face.normal.dot(points[v[0]]);
  double largest = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    highest = std::max(highest, face.normal.dot(points[i]));
    largest = std::max(largest, points[i].lpNorm<1>());
  }
  face.offset_m = highest + kRounding * largest + geometry::kSmallestNormal;
  return face;
}

/// Convex polygon of points in one plane, without those on its edges: Andrew 1979, "Another
/// efficient algorithm for convex hulls in two dimensions", on the projection along `axis`.
std::vector<Index> polygon(const ExactPoints& points, std::size_t axis) {
  const auto along = [&](Index i, std::size_t k) {
    return points[i][static_cast<Eigen::Index>((axis + k) % 3)];
  };
  std::vector<Index> order(points.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::ranges::sort(order, {}, [&](Index i) { return std::tuple(along(i, 1), along(i, 2), i); });
  std::vector<Index> chain;
  const auto add_half = [&](const auto& begin, const auto& end) {
    const std::size_t start = chain.size();
    for (auto it = begin; it != end; ++it) {
      while (chain.size() >= start + 2 &&
             points.turn(chain[chain.size() - 2], chain.back(), *it, axis) <= 0)
        chain.pop_back();
      chain.push_back(*it);
    }
    chain.pop_back();  // where the other half begins
  };
  add_half(order.begin(), order.end());
  add_half(order.rbegin(), order.rend());
  return chain;
}

/// As many points in general position as there are, up to four.
std::vector<Index> simplex_of(const ExactPoints& points) {
  const auto less = [&](Index i, Index k) { return precedes(points[i], points[k]); };
  std::vector<Index> all(points.size());
  std::iota(all.begin(), all.end(), Index{0});
  const auto [low, high] = std::ranges::minmax_element(all, less);
  std::vector<Index> simplex{*low};
  if (points[*low] == points[*high]) return simplex;
  simplex.push_back(*high);  // of a set on a line, these are the ends
  const auto off_line = std::ranges::find_if(
      all, [&](Index i) { return !points.collinear(simplex[0], simplex[1], i); });
  if (off_line == all.end()) return simplex;
  simplex.push_back(*off_line);
  const auto off_plane = std::ranges::find_if(
      all, [&](Index i) { return points.side(simplex[0], simplex[1], simplex[2], i) != 0; });
  if (off_plane != all.end()) simplex.push_back(*off_plane);
  return simplex;
}

}  // namespace

ConvexHull convex_hull(std::span<const Vec3> given) {
  const ExactPoints points(given);
  const std::vector<Index> s = simplex_of(points);
  if (s.size() == 1) return {{{s[0], s[0], s[0]}}, {}};
  if (s.size() == 2) return {{{s[0], s[1], s[1]}}, {}};
  ConvexHull hull;
  if (s.size() == 3) {
    Eigen::Index axis = 0;
    points.unit_normal(s[0], s[1], s[2]).cwiseAbs().maxCoeff(&axis);
    const std::vector<Index> corners = polygon(points, static_cast<std::size_t>(axis));
    for (std::size_t i = 2; i < corners.size(); ++i)
      hull.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    return hull;
  }
  const Quickhull surface(points, {s[0], s[1], s[2], s[3]});
  hull.triangles = surface.triangles();
  for (const Indices& plane : surface.planes()) hull.faces.push_back(half_space(points, plane));
  return hull;
}

}  // namespace camway::geometry
