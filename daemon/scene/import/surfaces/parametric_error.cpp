// SPDX-License-Identifier: MIT
#include "daemon/scene/import/surfaces/parametric_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/import/surfaces/bezier_net.h"
#include "daemon/scene/import/surfaces/knot_axis.h"
#include "daemon/scene/import/surfaces/surface_points.h"

namespace camway::scene::surfaces {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// How often a triangle is cut into four. Twice takes the second term of its bound to a sixteenth.
constexpr int kMostCuts = 2;

/// A triangle is not cut where the second term is less than this part of the first: what could be
/// gained.
constexpr double kWorthCutting = 0.1;

/// A triangle has turned over if its area is less than 0 by this part of the rectangle around it;
/// the area of a thin one is rounded.
constexpr double kTurned = 1e-10;

/// Blossoms of a surface of degrees p and q round p + q times per coordinate, by three operations,
/// differences and quotients by a few more; within a span their factors are from 0 to 1. Doubled
/// twice for parts that reach a little out of it.
constexpr double kRoundoffsPerDegree = 32.0;

double length(const Point& a) { return std::hypot(a[0], a[1], a[2]); }

double distance(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// A point of a triangle: its parameters, where the triangle has it, and how far S is from that.
struct Corner {
  Parameters at{};
  Point flat{};
  double off = 0.0;
};
using Polygon = std::vector<Corner>;

/// Bounds over a rectangle, whose sides count as of length 1.
struct DerivativeBounds {
  double u = 0.0;
  double v = 0.0;
  double uu = 0.0;
  double uv = 0.0;
  double vv = 0.0;
};

struct Rectangle {
  Parameters low{kInfinity, kInfinity};
  Parameters high{-kInfinity, -kInfinity};

  void include(const Parameters& at) {
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], at[k]);
      high[k] = std::max(high[k], at[k]);
    }
  }
  [[nodiscard]] double extent(std::size_t axis) const { return high[axis] - low[axis]; }
};

/// Largest lengths of differences of control points, and of their weights.
struct Difference {
  double point = 0.0;
  double weight = 0.0;
};

/// A rational Bezier patch S less the linear map L through three of its corners, w S - w L: the
/// coefficients of products are those of raising the degree.
class PatchLessLinear {
 public:
  PatchLessLinear(const Net& net, std::size_t p, std::size_t q) : p_(p + 1), q_(q + 1) {
    const Point origin = projected(net[0]);
    const Point at_u = projected(net[p]);
    const Point at_v = projected(net[q * (p + 1)]);
    std::array<Point, 4> corners = {origin, at_u, at_v, {}};
    for (std::size_t k = 0; k < 3; ++k) corners[3][k] = at_u[k] + at_v[k] - origin[k];
    linear_u_ = distance(at_u, origin);
    linear_v_ = distance(at_v, origin);
    for (std::size_t j = 0; j <= q_; ++j) {
      for (std::size_t i = 0; i <= p_; ++i) net_.push_back(coefficient(net, corners, i, j));
    }
  }

  [[nodiscard]] double linear_u() const { return linear_u_; }
  [[nodiscard]] double linear_v() const { return linear_v_; }

  /// The differences of order i in u and j in v, times the factors of a derivative.
  [[nodiscard]] Difference of_order(std::size_t i, std::size_t j) const {
    Difference largest;
    if (i > p_ || j > q_) return largest;
    for (std::size_t b = 0; b + j <= q_; ++b) {
      for (std::size_t a = 0; a + i <= p_; ++a) {
        const WeightedPoint d = difference(a, b, i, j);
        largest.point = std::max(largest.point, length({d[0], d[1], d[2]}));
        largest.weight = std::max(largest.weight, std::abs(d[3]));
      }
    }
    double factor = 1.0;
    for (std::size_t k = 0; k < i; ++k) factor *= static_cast<double>(p_ - k);
    for (std::size_t k = 0; k < j; ++k) factor *= static_cast<double>(q_ - k);
    return {factor * largest.point, factor * largest.weight};
  }
  [[nodiscard]] double least_weight() const {
    return std::ranges::min_element(net_, {}, [](const WeightedPoint& p) { return p[3]; })->at(3);
  }
  /// Largest length of S - L. Requires weights that are positive.
  [[nodiscard]] double reach() const {
    double largest = 0.0;
    for (const WeightedPoint& point : net_) largest = std::max(largest, length(projected(point)));
    return largest;
  }

 private:
  [[nodiscard]] WeightedPoint coefficient(const Net& net, const std::array<Point, 4>& corners,
                                          std::size_t i, std::size_t j) const {
    const double u = static_cast<double>(i) / static_cast<double>(p_);
    const double v = static_cast<double>(j) / static_cast<double>(q_);
    WeightedPoint sum{};
    for (std::size_t c = 0; c < 4; ++c) {
      const std::size_t a = c % 2;
      const std::size_t b = c / 2;
      if (i < a || j < b || i - a >= p_ || j - b >= q_) continue;
      const double factor = (a == 0 ? 1.0 - u : u) * (b == 0 ? 1.0 - v : v);
      const WeightedPoint& point = net[(j - b) * p_ + (i - a)];
      for (std::size_t k = 0; k < 3; ++k) sum[k] += factor * (point[k] - point[3] * corners[c][k]);
      sum[3] += factor * point[3];
    }
    return sum;
  }

  [[nodiscard]] WeightedPoint difference(std::size_t a, std::size_t b, std::size_t i,
                                         std::size_t j) const {
    if (i > 0) return less(difference(a + 1, b, i - 1, j), difference(a, b, i - 1, j));
    if (j > 0) return less(difference(a, b + 1, i, j - 1), difference(a, b, i, j - 1));
    return net_[b * (p_ + 1) + a];
  }
  static WeightedPoint less(WeightedPoint x, const WeightedPoint& y) {
    for (std::size_t k = 0; k < 4; ++k) x[k] -= y[k];
    return x;
  }

  Net net_;
  std::size_t p_;
  std::size_t q_;
  double linear_u_ = 0.0;
  double linear_v_ = 0.0;
};

/// The bounds in the header.
DerivativeBounds bounds_of(const PatchLessLinear& patch) {
  const double weight = patch.least_weight();
  if (!(weight > 0.0)) return {kInfinity, kInfinity, kInfinity, kInfinity, kInfinity};
  const double reach = patch.reach();
  const Difference u = patch.of_order(1, 0);
  const Difference v = patch.of_order(0, 1);
  const Difference uu = patch.of_order(2, 0);
  const Difference uv = patch.of_order(1, 1);
  const Difference vv = patch.of_order(0, 2);
  DerivativeBounds result;
  result.u = (u.point + u.weight * reach) / weight;
  result.v = (v.point + v.weight * reach) / weight;
  result.uu = (uu.point + 2.0 * u.weight * result.u + uu.weight * reach) / weight;
  result.vv = (vv.point + 2.0 * v.weight * result.v + vv.weight * reach) / weight;
  result.uv = (uv.point + u.weight * result.v + v.weight * result.u + uv.weight * reach) / weight;
  result.u += patch.linear_u();
  result.v += patch.linear_v();
  return result;
}

/// A surface with its two directions.
class Directions {
 public:
  explicit Directions(const ParametricSurface& surface)
      : surface_(surface.surface), points_(surface) {}

  [[nodiscard]] const KnotAxis& axis(std::size_t k) const { return points_.axis(k); }
  [[nodiscard]] Point point(const Parameters& at) const { return points_.point(at); }

  /// Bounds over a rectangle in which no knot is.
  [[nodiscard]] DerivativeBounds bounds(const Rectangle& of) const {
    const SpanPart u = axis(0).part(of.low[0], of.high[0]);
    const SpanPart v = axis(1).part(of.low[1], of.high[1]);
    return bounds_of(
        PatchLessLinear(bezier_net(surface_, u, v), axis(0).degree(), axis(1).degree()));
  }

  /// How far a computed point may be off.
  [[nodiscard]] double rounding() const {
    double largest = 0.0;
    double weight = kInfinity;
    for (const WeightedPoint& p : surface_.points) {
      largest = std::max(largest, length({p[0], p[1], p[2]}));
      weight = std::min(weight, p[3]);
    }
    const auto degrees = static_cast<double>(axis(0).degree() + axis(1).degree() + 1);
    return kRoundoffsPerDegree * degrees * geometry::kUnitRoundoff * largest / weight;
  }

 private:
  const NurbsSurface& surface_;
  SurfacePoints points_;
};

/// The largest bound of the triangles.
class TriangleErrors {
 public:
  explicit TriangleErrors(const Directions& surface) : surface_(surface) {}

  void add(const ParametricMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
    Polygon corners;
    for (const std::uint32_t node : triangle) {
      corners.push_back(corner(mesh.parameters[node], mesh.points[node]));
    }
    std::vector<Polygon> parts = {std::move(corners)};
    for (std::size_t axis = 0; axis < 2; ++axis) parts = cut_at_knots(parts, axis);
    for (const Polygon& part : parts) {
      for (std::size_t i = 1; i + 1 < part.size(); ++i) visit({part[0], part[i], part[i + 1]}, 0);
    }
  }
  [[nodiscard]] double largest() const { return largest_; }

 private:
  using Corners = std::array<Corner, 3>;

  [[nodiscard]] Corner corner(const Parameters& at, const Point& flat) const {
    const double off = distance(surface_.point(at), flat);
    return {at, flat, std::isnan(off) ? kInfinity : off};
  }

  [[nodiscard]] Corner between(const Corner& a, const Corner& b, double part) const {
    Parameters at;
    Point flat;
    for (std::size_t k = 0; k < 2; ++k) at[k] = (1.0 - part) * a.at[k] + part * b.at[k];
    for (std::size_t k = 0; k < 3; ++k) flat[k] = (1.0 - part) * a.flat[k] + part * b.flat[k];
    return corner(at, flat);
  }

  [[nodiscard]] std::vector<Polygon> cut_at_knots(const std::vector<Polygon>& polygons,
                                                  std::size_t axis) const {
    std::vector<Polygon> result;
    for (Polygon rest : polygons) {
      Rectangle box;
      for (const Corner& corner : rest) box.include(corner.at);
      for (const double knot : surface_.axis(axis).between(box.low[axis], box.high[axis])) {
        Polygon low;
        Polygon high;
        cut(rest, axis, knot, low, high);
        result.push_back(std::move(low));
        rest = std::move(high);
      }
      result.push_back(std::move(rest));
    }
    return result;
  }

  void cut(const Polygon& polygon, std::size_t axis, double knot, Polygon& low,
           Polygon& high) const {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Corner& a = polygon[i];
      const Corner& b = polygon[(i + 1) % polygon.size()];
      if (a.at[axis] <= knot) low.push_back(a);
      if (a.at[axis] >= knot) high.push_back(a);
      if ((a.at[axis] < knot) == (b.at[axis] < knot) || a.at[axis] == knot || b.at[axis] == knot) {
        continue;
      }
      Corner middle = between(a, b, (knot - a.at[axis]) / (b.at[axis] - a.at[axis]));
      middle.at[axis] = knot;
      low.push_back(middle);
      high.push_back(middle);
    }
  }

  /// Raises the bound to that of a triangle, or to those of its parts.
  void visit(const Corners& corners, int cuts) {
    Rectangle box;
    double off = 0.0;
    for (const Corner& corner : corners) {
      box.include(corner.at);
      off = std::max(off, corner.off);
    }
    const DerivativeBounds second = surface_.bounds(box);
    const double curved = 0.125 * (second.uu + 2.0 * second.uv + second.vv);
    const double bound = off + curved;
    if (bound <= largest_) return;
    if (cuts == kMostCuts || curved <= kWorthCutting * off || !(bound < kInfinity)) {
      largest_ = std::isnan(bound) ? kInfinity : bound;
      return;
    }
    const Corner a = between(corners[0], corners[1], 0.5);
    const Corner b = between(corners[1], corners[2], 0.5);
    const Corner c = between(corners[2], corners[0], 0.5);
    visit({a, b, c}, cuts + 1);
    visit({corners[0], a, c}, cuts + 1);
    visit({a, corners[1], b}, cuts + 1);
    visit({c, b, corners[2]}, cuts + 1);
  }

  const Directions& surface_;
  double largest_ = 0.0;
};

/// First derivatives by u and v over a rectangle, which knots may cross.
Parameters slopes(const Directions& surface, const Rectangle& box) {
  Parameters result{};
  std::array<std::vector<double>, 2> cuts;
  for (std::size_t k = 0; k < 2; ++k) {
    cuts[k] = surface.axis(k).cuts(box.low[k], box.high[k]);
  }
  for (std::size_t i = 0; i + 1 < cuts[0].size(); ++i) {
    for (std::size_t j = 0; j + 1 < cuts[1].size(); ++j) {
      const Rectangle part{{cuts[0][i], cuts[1][j]}, {cuts[0][i + 1], cuts[1][j + 1]}};
      const DerivativeBounds bounds = surface.bounds(part);
      const Parameters of_part = {bounds.u, bounds.v};
      for (std::size_t k = 0; k < 2; ++k) {
        if (part.extent(k) > 0.0) result[k] = std::max(result[k], of_part[k] / part.extent(k));
      }
    }
  }
  return result;
}

/// s of the header.
double sag_in(const Directions& surface, const ParametricMesh& mesh, const TrimPiece& piece) {
  const Parameters& a = mesh.parameters[piece.nodes[0]];
  const Parameters& b = mesh.parameters[piece.nodes[1]];
  Rectangle box;
  box.include(a);
  box.include(b);
  for (const Parameters& p : piece.hull) box.include(p);
  const Parameters slope = slopes(surface, box);
  const Parameters along = {slope[0] * (b[0] - a[0]), slope[1] * (b[1] - a[1])};
  const double square = along[0] * along[0] + along[1] * along[1];
  double largest = 0.0;
  for (const Parameters& p : piece.hull) {
    const Parameters to = {slope[0] * (p[0] - a[0]), slope[1] * (p[1] - a[1])};
    double part = square > 0.0 ? (to[0] * along[0] + to[1] * along[1]) / square : 0.0;
    part = std::clamp(part, 0.0, 1.0);
    largest = std::max(largest, std::hypot(to[0] - part * along[0], to[1] - part * along[1]));
  }
  return std::numbers::sqrt2 * largest;  // of the sum of two sides
}

/// Directed sides: how often each is run through from its smaller index to the larger, less how
/// often back.
class Chain {
 public:
  void add(std::uint32_t from, std::uint32_t to, int times) {
    if (from != to) sides_[std::minmax(from, to)] += from < to ? times : -times;
  }
  [[nodiscard]] bool is_empty() const {
    return std::ranges::all_of(sides_, [](const auto& side) { return side.second == 0; });
  }

 private:
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides_;
};

/// The check of the header: whether the triangles are the region within the chords.
std::string fault_of_cover(const ParametricMesh& mesh) {
  const auto at = [&](std::uint32_t node) { return mesh.parameters[node]; };
  for (const auto& [a, b, c] : mesh.triangles) {
    if (has_turned({at(a), at(b), at(c)})) return "has triangles that turn over";
  }
  Chain outline;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) outline.add(triangle[k], triangle[(k + 1) % 3], 1);
  }
  for (const TrimPiece& piece : mesh.boundary) outline.add(piece.nodes[0], piece.nodes[1], -1);
  return outline.is_empty() ? "" : "has triangles whose outline is not its boundary";
}

}  // namespace

bool has_turned(const std::array<Parameters, 3>& triangle) {
  Rectangle box;
  for (const Parameters& corner : triangle) box.include(corner);
  const auto& [a, b, c] = triangle;
  const double area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
  return !(area >= -kTurned * box.extent(0) * box.extent(1));
}

double sag_of(const ParametricSurface& surface, const ParametricMesh& mesh,
              const TrimPiece& piece) {
  return sag_in(Directions(surface), mesh, piece);
}

base::Result<double> error_of(const ParametricSurface& surface, const ParametricMesh& mesh) {
  if (std::string fault = fault_of(surface.surface); !fault.empty()) {
    return base::Failure{std::move(fault)};
  }
  if (std::string fault = fault_of_cover(mesh); !fault.empty()) {
    return base::Failure{std::move(fault)};
  }
  const Directions directions(surface);
  TriangleErrors triangles(directions);
  for (const auto& triangle : mesh.triangles) triangles.add(mesh, triangle);
  double sag = 0.0;
  for (const TrimPiece& piece : mesh.boundary) {
    sag = std::max(sag, sag_in(directions, mesh, piece));
  }
  const double error = triangles.largest() + sag + directions.rounding();
  if (!std::isfinite(error)) return base::Failure{"has a weight or a number that is of no use"};
  return error;
}

}  // namespace camway::scene::surfaces
