// SPDX-License-Identifier: MIT
#include "daemon/geometry/triangle_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/base/cpu_dispatch.h"
#include "daemon/geometry/lanes.h"
#include "daemon/geometry/rounding.h"
#include "daemon/geometry/triangle_intersection.h"

namespace camway::geometry {
namespace {

/// Vectors between the closest points of one segment and three, from the first to the others. If
/// the lines are parallel any parameter is correct: the end points, which the caller tries as well,
/// decide.
[[gnu::always_inline]] inline lanes::Vectors segment_offsets(const lanes::Vectors& p,
                                                             const lanes::Vectors& e,
                                                             const lanes::Vectors& q,
                                                             const lanes::Vectors& f) {
  using lanes::unit_quotient;
  const lanes::Vectors normal = cross(e, f);
  const lanes::Numbers first = unit_quotient(dot(cross(q - p, f), normal), squared_norm(normal));
  const lanes::Numbers t = unit_quotient(dot(f, p + first * e - q), squared_norm(f));
  // The second projection makes an error of the first harmless: see the derivation below.
  const lanes::Vectors on_second = q + t * f;
  const lanes::Numbers s = unit_quotient(dot(e, on_second - p), squared_norm(e));
  return on_second - (p + s * e);
}

/// Vectors from the closest points of a face to three points, where these are not on the outline.
[[gnu::always_inline]] inline lanes::Vectors offsets_from_face(const lanes::Vectors& face,
                                                               const lanes::Vectors& points) {
  using lanes::unit_quotient;
  const lanes::Vectors corner = lanes::repeat(face, 0);
  const Vec3 edge = get(face, 1) - get(face, 0);
  const Vec3 other_edge = get(face, 2) - get(face, 0);
  const lanes::Vectors e = lanes::repeat(edge);
  const lanes::Vectors f = lanes::repeat(other_edge);
  const lanes::Vectors normal = lanes::repeat(edge.cross(other_edge));
  const lanes::Numbers v =
      unit_quotient(dot(cross(points - corner, f), normal), squared_norm(normal));
  const lanes::Vectors on_edge = corner + v * e;
  // Within the triangle, the line through that point along f ends where the weights add up to 1.
  const lanes::Vectors rest = (1.0 - v) * f;
  const lanes::Numbers w = unit_quotient(dot(rest, points - on_edge), squared_norm(rest));
  return points - (on_edge + w * rest);
}

/// A square, a product and their comparison: fewer than 16 roundings.
constexpr double kBeyondRoundUp = 1.0 + 16.0 * kUnitRoundoff;

/// Keeps the shortest offset seen, and detects when it is proved to be the shortest of all.
class Search {
 public:
  Search(const lanes::Vectors& a, const lanes::Vectors& b, double scale, double beyond)
      : a_(a), b_(b), margin_(16.0 * kUnitRoundoff * scale), smallest_(4.0 * margin_) {
    // A slab wider than this is proved to be wide enough after its rounding (`margin_`) and that of
    // width and square; the computed distance would be off by its error once more.
    const double surely = (beyond + 2.0 * triangle_distance_error_m(scale)) * kBeyondRoundUp;
    beyond2_ = surely * surely;
  }

  /// Takes vectors from a point of `a` to a point of `b`. Returns whether the search is over.
  [[gnu::always_inline]] bool is_final(const lanes::Vectors& offsets) {
    const lanes::Numbers squared = squared_norm(offsets);
    const double least = std::min({squared[0], squared[1], squared[2]});
    if (!(least < best2_)) return false;
    best2_ = least;
    return proves(get(offsets, squared[0] == least ? 0 : squared[1] == least ? 1 : 2));
  }

  [[gnu::always_inline]] bool is_final(const Vec3& offset) {
    const double squared = offset.squaredNorm();
    if (!(squared < best2_)) return false;
    best2_ = squared;
    return proves(offset);
  }

  [[nodiscard]] bool is_beyond() const { return is_beyond_; }

  [[nodiscard]] const Vec3& offset() const { return offset_; }
  [[nodiscard]] double distance() const { return std::sqrt(best2_); }

 private:
  /// Whether the slab across an offset of length `best2_` proves it to be the shortest.
  [[gnu::always_inline]] bool proves(const Vec3& offset) {
    offset_ = offset;
    // Too short to prove anything by a slab; the exact test decides.
    if (!(best2_ > smallest_ * smallest_)) return false;
    const lanes::Vectors direction = lanes::repeat(offset);
    const lanes::Numbers a = dot(direction, a_);
    const lanes::Numbers b = dot(direction, b_);
    const double end_a = std::max({a[0], a[1], a[2]});
    const double begin_b = std::min({b[0], b[1], b[2]});
    const double rounding = margin_ * offset.lpNorm<1>();
    const double width = begin_b - end_a - rounding;
    is_beyond_ = width > 0.0 && width * width > beyond2_ * best2_;
    return is_beyond_ || begin_b - end_a >= best2_ - rounding;
  }

  const lanes::Vectors& a_;
  const lanes::Vectors& b_;
  double margin_;
  double smallest_;
  double beyond2_ = 0.0;
  bool is_beyond_ = false;
  double best2_ = std::numeric_limits<double>::infinity();
  Vec3 offset_ = Vec3::Zero();
};

[[gnu::always_inline]] inline bool edges_settle(Search& search, const lanes::Vectors& a,
                                                const lanes::Vectors& b) {
  const lanes::Vectors f = lanes::rotated(b) - b;
  for (std::size_t i = 0; i < 3; ++i) {
    const lanes::Vectors p = lanes::repeat(a, i);
    const lanes::Vectors e = lanes::repeat(a, (i + 1) % 3) - p;
    if (search.is_final(segment_offsets(p, e, b, f))) return true;
  }
  return false;
}

[[gnu::always_inline]] inline bool faces_settle(Search& search, const lanes::Vectors& a,
                                                const lanes::Vectors& b) {
  if (search.is_final(offsets_from_face(a, b))) return true;
  return search.is_final(-offsets_from_face(b, a));
}

bool is_point(const Triangle& triangle) {
  return triangle[0] == triangle[1] && triangle[0] == triangle[2];
}

/// The case where `a` is a point, in which most of these tests would be repeated.
[[gnu::always_inline]] inline bool point_settles(Search& search, const lanes::Vectors& point,
                                                 const lanes::Vectors& b) {
  if (search.is_final(-get(offsets_from_face(b, point), 0))) return true;
  const lanes::Vectors f = lanes::rotated(b) - b;
  const lanes::Numbers t = lanes::unit_quotient(dot(f, point - b), squared_norm(f));
  return search.is_final(b + t * f - point);
}

/// Vectors from the closest points of three edges, which begin at `from`, to `point`.
[[gnu::always_inline]] inline lanes::Vectors offsets_from_edges(const lanes::Vectors& from,
                                                                const lanes::Vectors& edges,
                                                                const lanes::Vectors& point) {
  const lanes::Numbers s = lanes::unit_quotient(dot(edges, point - from), squared_norm(edges));
  return point - (from + s * edges);
}

/// Every vertex against every edge. In exact arithmetic `edges_settle` covers these cases.
[[gnu::always_inline]] inline bool vertices_settle(Search& search, const lanes::Vectors& a,
                                                   const lanes::Vectors& b) {
  const lanes::Vectors edges_a = lanes::rotated(a) - a;
  const lanes::Vectors edges_b = lanes::rotated(b) - b;
  for (std::size_t i = 0; i < lanes::kLanes; ++i) {
    const lanes::Vectors of_a = offsets_from_edges(a, edges_a, lanes::repeat(b, i));
    const lanes::Vectors of_b = offsets_from_edges(b, edges_b, lanes::repeat(a, i));
    for (std::size_t j = 0; j < lanes::kLanes; ++j) {
      if (search.is_final(get(of_a, j)) || search.is_final(Vec3(-get(of_b, j)))) return true;
    }
  }
  return false;
}

double scale_of(const Triangle& a, const Triangle& b) {
  double scale = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    scale = std::max(
        {scale, (a[i] - a[0]).lpNorm<Eigen::Infinity>(), (b[i] - a[0]).lpNorm<Eigen::Infinity>()});
  }
  return scale;
}

/// A power of two that brings products of four coordinates well inside the range of doubles; 1 for
/// every size met in practice.
double unit_for_scale(double scale) {
  if (scale > 0x1p-200 && scale < 0x1p200) return 1.0;
  return std::ldexp(1.0, std::clamp(std::ilogb(scale), -1020, 1020));
}

}  // namespace

// With u = 2^-53 and every local coordinate at most `scale` in magnitude (lengths: |v| <= sqrt(3)
// times that, an edge |e| <= 2·sqrt(3)·scale):
// 1. Translation: each vertex moves by at most sqrt(3)·u·scale, the distance by twice that:
//    4u·scale.
// 2. Evaluation: p + s·e has per coordinate the rounding of e (2u), of the product (2u + 2u) and of
//    the sum (u), so 7u·scale, 12u·scale in length; two points and their difference: 28u·scale. The
//    points lie in the triangles otherwise, so the result is never below the distance by more than
//    1 + 2.
// 3. Parameters: let h be the angle between the edges and d their distance. The error of s shifts
//    the point along e by ds·|e|; t is then projected anew, so only ds·|e|·sin h =: x counts. e×f
//    has the relative error 4u/sin h, and q - p = s·e - t·f + d·n, so x <= 8u·(|e| + |q - p|) +
//    4u·d/sin h. Where the last term governs, the distance grows only to sqrt(d² + x²), by at most
//    x²/2d = 8u²d/sin² h; nor can it grow by more than (|e|·sin h)²/2d over the whole segment. The
//    smaller of the two is at most their geometric mean, 2u·|e|. Together 8u·(3.5 + 3.5) + 2u·3.5 =
//    63u·scale. For a face the same holds with its two edges; a projection on one segment has less.
// 4. A slab accepted too early: margin 16u·scale·|offset|_1/|offset|_2 <= 28u·scale, and as much
//    for the rounding of the six dot products: 56u·scale.
// 5. The final square root and sum of squares: 3u·2·sqrt(3)·scale = 11u·scale.
// Sum: 162u·scale; 192 covers the second order. Tests see about a tenth of it.
double triangle_distance_error_m(const Triangle& a, const Triangle& b) {
  return triangle_distance_error_m(scale_of(a, b));
}

double triangle_distance(const Triangle& a, const Triangle& b) {
  return triangle_distance(a, b, std::numeric_limits<double>::infinity());
}

double triangle_distance(const Triangle& a, const Triangle& b, double beyond_m) {
  return triangle_gap(a, b, beyond_m).distance_m;
}

// Coordinates relative to a vertex of `b` carry u·scale each, a product u and the sums 2u: 4u·|n|_1
// times scale for each end, 2u for their difference (which is at most twice as large): 12u, 21u
// once the length is divided out. Length and quotient have 5u of a width of at most
// 2·sqrt(3)·scale: 18u. Together 39u, far inside the 192u of the contract. A direction longer than
// the guard keeps underflow out.
double slab_width_m(const Triangle& a, const Triangle& b, const Vec3& direction) {
  constexpr double kLeastSquare = 0x1p-400;
  const double squared = direction.squaredNorm();
  if (!(squared > kLeastSquare)) return -std::numeric_limits<double>::infinity();
  const auto along = [&](const Vec3& point) { return direction.dot(point - b[0]); };
  const double begin = std::min({0.0, along(b[1]), along(b[2])});
  const double end = std::max({along(a[0]), along(a[1]), along(a[2])});
  return (begin - end) / std::sqrt(squared);
}

CAMWAY_FOR_EVERY_PROCESSOR
TriangleGap triangle_gap(const Triangle& a, const Triangle& b, double beyond_m) {
  // Relative to a vertex of `a`, in units of `unit_m`.
  const lanes::Vectors origin = lanes::repeat(a[0]);
  lanes::Vectors la = lanes::load(a) - origin;
  lanes::Vectors lb = lanes::load(b) - origin;
  const double scale = std::max(lanes::largest_coordinate(la), lanes::largest_coordinate(lb));
  const double unit_m = unit_for_scale(scale);
  if (unit_m != 1.0) {
    const double factor = 1.0 / unit_m;
    la = factor * la;
    lb = factor * lb;
  }
  Search search(la, lb, scale / unit_m, beyond_m / unit_m);
  const bool is_settled = is_point(a)
                              ? point_settles(search, la, lb)
                              : edges_settle(search, la, lb) || faces_settle(search, la, lb);
  if (is_settled) {
    if (search.is_beyond()) return {std::numeric_limits<double>::infinity(), search.offset()};
    return {search.distance() * unit_m, search.offset()};
  }
  if (triangles_touch(a, b)) return {0.0, search.offset()};
  vertices_settle(search, la, lb);
  // The triangles are apart, so the distance must not be 0.
  return {std::max(search.distance() * unit_m, std::numeric_limits<double>::denorm_min()),
          search.offset()};
}

}  // namespace camway::geometry
