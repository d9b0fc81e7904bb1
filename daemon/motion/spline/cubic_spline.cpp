// SPDX-License-Identifier: MIT
#include "daemon/motion/spline/cubic_spline.h"

#include <cassert>

namespace camway::motion {
namespace {

/// One equation `before·m[i-1] + at·m[i] + after·m[i+1] = right` of the tridiagonal system.
template <class Point>
struct Row {
  double before;
  double at;
  double after;
  Point right;
};

/// The first or last equation; `inner` is the coefficient of the neighbouring slope.
template <class Point>
struct EndRow {
  double at;
  double inner;
  Point right;
};

/// `h` and `d` are the length and the chord slope of the interval at the end, `h_next` and `d_next`
/// those of its neighbour.
template <class Point>
EndRow<Point> end_row(EndCondition ends, double h, const Point& d, double h_next,
                      const Point& d_next) {
  if (ends == EndCondition::kNatural) return {2.0, 1.0, Point(3.0 * d)};
  return {1.0, 0.0, Point(d + (h / (h + h_next)) * (d - d_next))};
}

/// Gaussian elimination without exchanges: safe, as every row is diagonally dominant.
template <class Point>
std::vector<Point> solve(std::vector<Row<Point>>& rows) {
  const std::size_t n = rows.size();
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = rows[i].before / rows[i - 1].at;
    rows[i].at -= factor * rows[i - 1].after;
    rows[i].right -= factor * rows[i - 1].right;
  }
  std::vector<Point> slopes(n);
  slopes[n - 1] = rows[n - 1].right / rows[n - 1].at;
  for (std::size_t i = n - 1; i-- > 0;)
    slopes[i] = (rows[i].right - rows[i].after * slopes[i + 1]) / rows[i].at;
  return slopes;
}

/// Lengths and chord slopes of the intervals between knots.
template <class Point>
struct Chords {
  std::vector<double> length;
  std::vector<Point> slope;
};

template <class Point>
Chords<Point> chords_of(std::span<const double> knots, std::span<const Point> points) {
  const std::size_t n = points.size();
  assert(n >= 2 && knots.size() == n);
  Chords<Point> chords;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    chords.length.push_back(knots[i + 1] - knots[i]);
    assert(chords.length[i] > 0.0);
    chords.slope.push_back(Point((points[i + 1] - points[i]) / chords.length[i]));
  }
  return chords;
}

/// The slopes with which the spline is C² at all inner knots and meets the end conditions.
template <class Point>
std::vector<Point> slopes_between(const Chords<Point>& chords, const EndRow<Point>& first,
                                  const EndRow<Point>& last) {
  const auto& [h, d] = chords;
  const std::size_t n = h.size() + 1;
  std::vector<Row<Point>> rows(n);
  rows[0] = {0.0, first.at, first.inner, first.right};
  rows[n - 1] = {last.inner, last.at, 0.0, last.right};
  for (std::size_t i = 1; i + 1 < n; ++i) {
    // Divided by the sum of the two inverse lengths, so that tiny intervals cannot overflow.
    const double left = h[i] / (h[i - 1] + h[i]);
    const double right = h[i - 1] / (h[i - 1] + h[i]);
    rows[i] = {left, 2.0, right, Point(3.0 * (left * d[i - 1] + right * d[i]))};
  }
  return solve(rows);
}

}  // namespace

template <class Point>
std::vector<Point> spline_slopes(std::span<const double> knots, std::span<const Point> points,
                                 EndCondition ends) {
  const Chords<Point> chords = chords_of(knots, points);
  const auto& [h, d] = chords;
  const std::size_t n = points.size();
  if (n == 2) return {d[0], d[0]};
  return slopes_between(chords, end_row<Point>(ends, h[0], d[0], h[1], d[1]),
                        end_row<Point>(ends, h[n - 2], d[n - 2], h[n - 3], d[n - 3]));
}

template <class Point>
std::vector<Point> spline_slopes(std::span<const double> knots, std::span<const Point> points,
                                 const Point& first_slope, const Point& last_slope) {
  return slopes_between(chords_of(knots, points), EndRow<Point>{1.0, 0.0, first_slope},
                        EndRow<Point>{1.0, 0.0, last_slope});
}

template std::vector<geometry::Vec3> spline_slopes(std::span<const double>,
                                                   std::span<const geometry::Vec3>, EndCondition);
template std::vector<geometry::Vec4> spline_slopes(std::span<const double>,
                                                   std::span<const geometry::Vec4>, EndCondition);
template std::vector<geometry::Vec3> spline_slopes(std::span<const double>,
                                                   std::span<const geometry::Vec3>,
                                                   const geometry::Vec3&, const geometry::Vec3&);
template std::vector<geometry::Vec4> spline_slopes(std::span<const double>,
                                                   std::span<const geometry::Vec4>,
                                                   const geometry::Vec4&, const geometry::Vec4&);

}  // namespace camway::motion
