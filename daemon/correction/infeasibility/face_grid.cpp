// SPDX-License-Identifier: MIT
#include "daemon/correction/infeasibility/face_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "daemon/correction/infeasibility/surface_parity.h"
#include "daemon/geometry/ray_crossing.h"
#include "daemon/geometry/rounding.h"

namespace camway::correction {
namespace {

using geometry::precedes;
using geometry::Triangle;
using geometry::Vec3;

/// Rounding of a section, in units of rounding u of the largest coordinate of triangle and face.
/// The fraction along an edge has 3u of its length, at most twice that coordinate; product and sum
/// add 3u, clipping to a row the same again: 18u. Lines are exact.
constexpr double kSectionRounding = 64.0;

/// Rounding of the diagonal of a box of cells, times more than a thousand: two differences and a
/// hypotenuse within 1 ulp.
constexpr double kWidthRounding = 1e-12;

void clip_to_row(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double low, double high,
                 double& from, double& to) {
  const auto add = [&](double u) {
    from = std::min(from, u);
    to = std::max(to, u);
  };
  for (const auto& p : {a, b}) {
    if (p.y() >= low && p.y() <= high) add(p.x());
  }
  for (const double v : {low, high}) {
    if ((a.y() < v) == (b.y() < v)) continue;
    add(a.x() + (b.x() - a.x()) * ((v - a.y()) / (b.y() - a.y())));
  }
}

/// A corner: its exact coordinates, which identify it, and its place in the face.
struct Corner {
  Vec3 exact;
  Eigen::Vector2d seen;
};
using FlatCorners = std::array<Corner, 3>;  // in order of their exact coordinates
using Edge = std::pair<Corner, Corner>;

bool is_before(const Corner& a, const Corner& b) { return precedes(a.exact, b.exact); }

/// Drops repeated triangles: two copies would cancel modulo 2, but cover the same cells.
void drop_copies(std::vector<FlatCorners>& triangles) {
  std::sort(triangles.begin(), triangles.end(), [](const FlatCorners& a, const FlatCorners& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), is_before);
  });
  const auto same = [](const FlatCorners& a, const FlatCorners& b) {
    return std::equal(a.begin(), a.end(), b.begin(),
                      [](const Corner& p, const Corner& q) { return p.exact == q.exact; });
  };
  triangles.erase(std::unique(triangles.begin(), triangles.end(), same), triangles.end());
}

/// Edges that belong to an odd number of the triangles.
std::vector<Edge> odd_edges(const std::vector<FlatCorners>& triangles) {
  std::vector<Edge> edges;
  for (const auto& [a, b, c] : triangles) {
    edges.insert(edges.end(), {Edge(a, b), Edge(b, c), Edge(a, c)});
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.first.exact != b.first.exact ? is_before(a.first, b.first)
                                          : is_before(a.second, b.second);
  });
  std::vector<Edge> odd;
  for (const Edge& edge : edges) {
    if (!odd.empty() && odd.back().first.exact == edge.first.exact &&
        odd.back().second.exact == edge.second.exact) {
      odd.pop_back();
    } else {
      odd.push_back(edge);
    }
  }
  return odd;
}

/// Maps a point of the face to the plane x = 1, where a ray along x from x = 0 meets it.
Vec3 ahead_of(const Eigen::Vector2d& point) { return {1.0, point.x(), point.y()}; }

}  // namespace

FaceGrid::FaceGrid(int axis, double at, std::array<Lines, 2> lines, const Vec3& margin_m)
    : axis_(axis),
      at_(at),
      axes_{(axis + 1) % 3, (axis + 2) % 3},
      lines_(std::move(lines)),
      margin_m_(margin_m),
      largest_m_(std::abs(at)),
      blocked_((lines_[0].size() - 1) * (lines_[1].size() - 1), 0) {
  for (const Lines& line : lines_) {
    largest_m_ = std::max({largest_m_, std::abs(line.front()), std::abs(line.back())});
  }
}

int FaceGrid::last_element(int k) const {
  return 2 * static_cast<int>(lines_[static_cast<std::size_t>(k)].size()) - 2;
}

int FaceGrid::element_of(int k, double x) const {
  const Lines& lines = lines_[static_cast<std::size_t>(k)];
  const auto line = std::lower_bound(lines.begin(), lines.end(), x);
  const int below = 2 * static_cast<int>(line - lines.begin()) - 1;
  return line != lines.end() && *line == x ? below + 1 : below;
}

std::array<double, 2> FaceGrid::ends_of(int k, int element) const {
  const Lines& lines = lines_[static_cast<std::size_t>(k)];
  const std::size_t first = static_cast<std::size_t>(element / 2);
  return {lines[first], lines[first + static_cast<std::size_t>(element % 2)]};
}

FaceGrid::Window FaceGrid::window_of(const Flat& bounds) const {
  return {.u0 = std::max(0, element_of(0, bounds.min().x())),
          .v0 = std::max(0, element_of(1, bounds.min().y())),
          .u1 = std::min(last_element(0), element_of(0, bounds.max().x())),
          .v1 = std::min(last_element(1), element_of(1, bounds.max().y()))};
}

Vec3 FaceGrid::in_space(const Point& point) const {
  Vec3 result;
  result[axis_] = at_;
  result[axes_[0]] = point.x();
  result[axes_[1]] = point.y();
  return result;
}

double FaceGrid::rounding_m(const Triangle& triangle) const {
  double largest_m = largest_m_;
  for (const Vec3& corner : triangle) {
    largest_m = std::max(largest_m, corner.lpNorm<Eigen::Infinity>());
  }
  return kSectionRounding * geometry::kUnitRoundoff * largest_m;
}

FaceGrid::Section FaceGrid::section(const Triangle& triangle) const {
  Section result;
  result.margin_m = rounding_m(triangle);
  const double low = at_ - margin_m_[axis_];
  const double high = at_ + margin_m_[axis_];
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& a = triangle[k];
    const Vec3& b = triangle[(k + 1) % 3];
    const Point flat_a(a[axes_[0]], a[axes_[1]]);
    const Point flat_b(b[axes_[0]], b[axes_[1]]);
    if (a[axis_] >= low && a[axis_] <= high) {
      result.points.push_back(flat_a);
      result.bounds.extend(flat_a);
    }
    for (std::size_t i = 0; i < (low < high ? 2U : 1U); ++i) {
      const double plane = i == 0 ? low : high;
      if (!(std::min(a[axis_], b[axis_]) < plane && std::max(a[axis_], b[axis_]) > plane)) continue;
      const double fraction = (plane - a[axis_]) / (b[axis_] - a[axis_]);
      const Point between = flat_a + fraction * (flat_b - flat_a);
      result.points.push_back(between);
      // The point is rounded but lies between both ends: exact where an edge is parallel to an
      // axis.
      const Flat edge(flat_a.cwiseMin(flat_b), flat_a.cwiseMax(flat_b));
      const Point margin = Point::Constant(result.margin_m);
      result.bounds.extend(Point((between - margin).cwiseMax(edge.min())));
      result.bounds.extend(Point((between + margin).cwiseMin(edge.max())));
    }
  }
  return result;
}

void FaceGrid::mark(const Section& section, const Window& window,
                    std::vector<std::uint8_t>& touched) const {
  const std::vector<Point>& points = section.points;
  if (points.empty()) return;
  const Point known_to_m(margin_m_[axes_[0]], margin_m_[axes_[1]]);
  const double margin_m = section.margin_m + known_to_m.maxCoeff();
  Flat bounds = section.bounds;
  bounds.min() -= known_to_m;
  bounds.max() += known_to_m;
  const int last = std::min(window.v1, element_of(1, bounds.max().y()));
  for (int v = std::max(window.v0, element_of(1, bounds.min().y())); v <= last; ++v) {
    const auto [low, high] = ends_of(1, v);
    double from = std::numeric_limits<double>::infinity();
    double to = -from;
    for (const Point& a : points) {
      for (const Point& b : points) {
        clip_to_row(a, b, low - margin_m, high + margin_m, from, to);
      }
    }
    if (from > to) continue;
    from = std::max(from - margin_m, bounds.min().x());
    to = std::min(to + margin_m, bounds.max().x());
    const int end = std::min(window.u1, element_of(0, to));
    for (int u = std::max(window.u0, element_of(0, from)); u <= end; ++u) {
      touched[window.at(u, v)] = 1;
    }
  }
}

std::size_t FaceGrid::block(const scene::Mesh& mesh, std::span<const std::uint32_t> triangles,
                            bool body_is_odd) {
  geometry::Box bounds;
  for (const std::uint32_t t : triangles) bounds.extend(geometry::bounds(mesh.triangle(t)));
  if (bounds.isEmpty()) return 0;
  Window window = whole();
  if (!body_is_odd) {  // what lies outside the bounds is even
    if (bounds.min()[axis_] - margin_m_[axis_] > at_ ||
        bounds.max()[axis_] + margin_m_[axis_] < at_) {
      return triangles.size();
    }
    window = window_of({Point(bounds.min()[axes_[0]], bounds.min()[axes_[1]]),
                        Point(bounds.max()[axes_[0]], bounds.max()[axes_[1]])});
    if (window.u0 > window.u1 || window.v0 > window.v1) return triangles.size();
  }
  std::vector<std::uint8_t> touched(window.size(), 0);
  for (const std::uint32_t t : triangles) {
    const Triangle triangle = mesh.triangle(t);
    mark(section(triangle), window, touched);
  }
  // A part that no triangle touches is on one side.
  const std::size_t parts =
      block_parts(window, std::move(touched), [&](const Point& point) -> bool {
        const std::optional<bool> odd = is_odd(in_space(point), mesh, triangles);
        return odd && *odd != body_is_odd;
      });
  return window.size() + (parts + 1) * triangles.size();
}

std::size_t FaceGrid::block_flat(const scene::Mesh& mesh, const scene::Mesh& exact,
                                 std::span<const std::uint32_t> triangles) {
  std::vector<FlatCorners> flat;
  Flat bounds;
  for (const std::uint32_t t : triangles) {
    const Triangle seen = mesh.triangle(t);
    const Triangle told_by = exact.triangle(t);
    FlatCorners corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = {told_by[k], Point(seen[k][axes_[0]], seen[k][axes_[1]])};
      bounds.extend(corners[k].seen);
    }
    std::sort(corners.begin(), corners.end(), is_before);
    flat.push_back(corners);
  }
  if (flat.empty()) return 0;
  const Window window = window_of(bounds);
  if (window.u0 > window.u1 || window.v0 > window.v1) return flat.size();
  drop_copies(flat);
  std::vector<std::uint8_t> touched(window.size(), 0);
  for (const auto& [a, b] : odd_edges(flat)) {
    Section edge{.points = {a.seen, b.seen}, .bounds = Flat(a.seen), .margin_m = 0.0};
    edge.bounds.extend(b.seen);
    edge.margin_m = rounding_m({in_space(a.seen), in_space(a.seen), in_space(b.seen)});
    mark(edge, window, touched);
  }
  // The number of covering triangles modulo 2 changes only at the edges marked.
  const std::size_t parts =
      block_parts(window, std::move(touched), [&](const Point& point) -> bool {
        bool odd = false;
        for (const auto& [a, b, c] : flat) {
          const Triangle ahead = {ahead_of(a.seen), ahead_of(b.seen), ahead_of(c.seen)};
          odd ^=
              geometry::passes_through(geometry::ray_hit(Vec3(0.0, point.x(), point.y()), ahead));
        }
        return odd;
      });
  return window.size() + (parts + 1) * flat.size();
}

std::size_t FaceGrid::block_parts(const Window& window, std::vector<std::uint8_t> touched,
                                  const std::function<bool(const Point&)>& is_blocked) {
  std::size_t parts = 0;
  for (int v = window.v0; v <= window.v1; ++v) {
    for (int u = window.u0; u <= window.u1; ++u) {
      if (touched[window.at(u, v)] != 0) continue;
      const std::vector<Run> part = take_part(window, u, v, touched);
      const std::optional<Point> point = point_in(part);
      if (!point) continue;
      ++parts;
      if (!is_blocked(*point)) continue;
      for (const Run& run : part) {
        if (run.v % 2 == 0) continue;
        for (int cell_u = run.u0 | 1; cell_u <= run.u1; cell_u += 2) {
          blocked_[cell(static_cast<std::size_t>(cell_u / 2),
                        static_cast<std::size_t>(run.v / 2))] = 1;
        }
      }
    }
  }
  return parts;
}

std::optional<FaceGrid::Point> FaceGrid::point_in(const std::vector<Run>& part) const {
  for (const Run& run : part) {
    if (run.v % 2 == 0) continue;
    for (int u = run.u0 | 1; u <= run.u1; u += 2) {
      const auto [left, right] = ends_of(0, u);
      const auto [low, high] = ends_of(1, run.v);
      const Point middle(0.5 * (left + right), 0.5 * (low + high));
      if (left < middle.x() && middle.x() < right && low < middle.y() && middle.y() < high) {
        return middle;
      }
    }
  }
  return std::nullopt;
}

FaceGrid::Run FaceGrid::take_run(const Window& window, int u, int v,
                                 std::vector<std::uint8_t>& done) {
  Run run{v, u, u};
  while (run.u0 > window.u0 && done[window.at(run.u0 - 1, v)] == 0) --run.u0;
  while (run.u1 < window.u1 && done[window.at(run.u1 + 1, v)] == 0) ++run.u1;
  const auto first = done.begin() + static_cast<std::ptrdiff_t>(window.at(run.u0, v));
  std::fill(first, first + (run.u1 - run.u0 + 1), std::uint8_t{1});
  return run;
}

// Run by run: a part has many elements, but few runs.
std::vector<FaceGrid::Run> FaceGrid::take_part(const Window& window, int u, int v,
                                               std::vector<std::uint8_t>& done) {
  std::vector<Run> part = {take_run(window, u, v, done)};
  for (std::size_t i = 0; i < part.size(); ++i) {
    const Run run = part[i];
    for (const int next_v : {run.v - 1, run.v + 1}) {
      if (next_v < window.v0 || next_v > window.v1) continue;
      for (int next_u = run.u0; next_u <= run.u1; ++next_u) {
        if (done[window.at(next_u, next_v)] == 0)
          part.push_back(take_run(window, next_u, next_v, done));
      }
    }
  }
  return part;
}

bool FaceGrid::is_blocked_at_border(int axis, bool at_max, std::size_t index) const {
  const bool along_u = axis == axes_[0];
  const std::size_t last = lines_[along_u ? 0 : 1].size() - 2;
  const std::size_t across = at_max ? last : 0;
  return blocked_[along_u ? cell(across, index) : cell(index, across)] != 0;
}

std::optional<double> FaceGrid::widest_hole_m(const BorderIsBlocked& border) const {
  const std::size_t last_u = lines_[0].size() - 2;
  const std::size_t last_v = lines_[1].size() - 2;
  const auto is_way_out = [&](std::size_t u, std::size_t v) {
    return (u == 0 && !border(axes_[0], false, v)) || (u == last_u && !border(axes_[0], true, v)) ||
           (v == 0 && !border(axes_[1], false, u)) || (v == last_v && !border(axes_[1], true, u));
  };
  std::vector<std::uint8_t> done = blocked_;
  std::vector<std::pair<std::size_t, std::size_t>> hole;
  double widest_m = 0.0;
  for (std::size_t v0 = 0; v0 <= last_v; ++v0) {
    for (std::size_t u0 = 0; u0 <= last_u; ++u0) {
      if (std::exchange(done[cell(u0, v0)], std::uint8_t{1}) != 0) continue;
      hole.assign(1, {u0, v0});
      std::array<std::size_t, 4> range = {u0, u0, v0, v0};
      while (!hole.empty()) {
        const auto [u, v] = hole.back();
        hole.pop_back();
        if (is_way_out(u, v)) return std::nullopt;
        range = {std::min(range[0], u), std::max(range[1], u), std::min(range[2], v),
                 std::max(range[3], v)};
        // Also connect cells that share only a corner, to be conservative.
        for (std::size_t next_v = v - std::min<std::size_t>(v, 1);
             next_v <= std::min(v + 1, last_v); ++next_v) {
          for (std::size_t next_u = u - std::min<std::size_t>(u, 1);
               next_u <= std::min(u + 1, last_u); ++next_u) {
            if (std::exchange(done[cell(next_u, next_v)], std::uint8_t{1}) == 0) {
              hole.emplace_back(next_u, next_v);
            }
          }
        }
      }
      widest_m = std::max(widest_m, std::hypot(lines_[0][range[1] + 1] - lines_[0][range[0]],
                                               lines_[1][range[3] + 1] - lines_[1][range[2]]));
    }
  }
  return widest_m * (1.0 + kWidthRounding);
}

}  // namespace camway::correction
