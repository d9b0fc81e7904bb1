// SPDX-License-Identifier: MIT
#include "daemon/scene/import/surfaces/nurbs_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "daemon/scene/import/surfaces/bezier_net.h"

namespace camway::scene::surfaces {
namespace {

/// Divisions of one span of knots; more are finer than a float.
constexpr std::size_t kMostDivisions = 4096;

constexpr double kUnknown = -1.0;  ///< an error that is not computed

/// A span of knots with a length, between knots number `knot` and the next.
struct Span {
  std::size_t knot = 0;
  std::size_t divisions = 1;
};

std::vector<Span> spans_of(const std::vector<double>& knots, std::size_t degree) {
  std::vector<Span> spans;
  for (std::size_t i = degree; i + 1 < knots.size() - degree; ++i) {
    if (knots[i] < knots[i + 1]) spans.push_back({i, 1});
  }
  return spans;
}

/// The control points of the part [low, high] of a Bezier curve whose points are `stride` apart.
void cut_bezier(WeightedPoint* points, std::size_t stride, std::size_t degree, double low,
                double high) {
  std::array<WeightedPoint, kMostDegree + 1> result;
  for (std::size_t j = 0; j <= degree; ++j) {
    std::array<WeightedPoint, kMostDegree + 1> work;
    for (std::size_t i = 0; i <= degree; ++i) work[i] = points[i * stride];
    for (std::size_t r = 1; r <= degree; ++r) {
      const double argument = r <= j ? high : low;
      for (std::size_t i = 0; i + r <= degree; ++i) work[i] = mixed(work[i], work[i + 1], argument);
    }
    result[j] = work[0];
  }
  for (std::size_t i = 0; i <= degree; ++i) points[i * stride] = result[i];
}

/// Cuts a surface into Bezier patches, and these into cells.
class Facets {
 public:
  Facets(const NurbsSurface& surface, std::size_t u_degree, std::size_t v_degree,
         const GridSize& least)
      : p_(u_degree),
        q_(v_degree),
        u_spans_(spans_of(surface.u_knots, u_degree)),
        v_spans_(spans_of(surface.v_knots, v_degree)) {
    for (Span& u : u_spans_) u.divisions = least.u;
    for (Span& v : v_spans_) v.divisions = least.v;
    for (const Span& v : v_spans_) {
      for (const Span& u : u_spans_) {
        patches_.push_back(
            bezier_net(surface, whole(surface.u_knots, u), whole(surface.v_knots, v)));
      }
    }
  }
  [[nodiscard]] bool is_empty() const { return patches_.empty(); }

  FacetedGrid made(double tolerance) {
    std::vector<double> errors(patches_.size(), kUnknown);
    while (refine(tolerance, errors)) {
    }
    for_each_patch([&](std::size_t i, Span& u, Span& v) { find_error(i, u, v, errors); });
    FacetedGrid result{grid(), {total(u_spans_), total(v_spans_)}};
    result.facets.error = *std::max_element(errors.begin(), errors.end());
    return result;
  }

 private:
  template <class Visit>
  void for_each_patch(const Visit& visit) {
    std::size_t i = 0;
    for (Span& v : v_spans_) {
      for (Span& u : u_spans_) visit(i++, u, v);
    }
  }

  /// Divides the spans of patches whose error is too large, each once. Returns whether there were
  /// any, and the grid is not too fine.
  bool refine(double tolerance, std::vector<double>& errors) {
    const std::vector<Span> u_before = u_spans_;
    const std::vector<Span> v_before = v_spans_;
    const std::size_t width = u_spans_.size();
    const auto is_divided = [&](std::size_t i) {
      return u_spans_[i % width].divisions != u_before[i % width].divisions ||
             v_spans_[i / width].divisions != v_before[i / width].divisions;
    };
    bool is_finer = false;
    for_each_patch([&](std::size_t i, Span& u, Span& v) {
      if (is_divided(i)) return;  // perhaps that is enough
      find_error(i, u, v, errors);
      if (errors[i] > tolerance) is_finer = divide(i, u, v) || is_finer;
    });
    if (total(u_spans_) * total(v_spans_) > kMostCells) {
      u_spans_ = u_before;
      v_spans_ = v_before;
      return false;
    }
    for (std::size_t i = 0; i < errors.size(); ++i) {
      if (is_divided(i)) errors[i] = kUnknown;
    }
    return is_finer;
  }

  void find_error(std::size_t i, const Span& u, const Span& v, std::vector<double>& errors) const {
    if (errors[i] == kUnknown) errors[i] = patch_error(i, u.divisions, v.divisions);
  }

  static std::size_t total(const std::vector<Span>& spans) {
    std::size_t sum = 0;
    for (const Span& span : spans) sum += span.divisions;
    return sum;
  }

  static SpanPart whole(const std::vector<double>& knots, const Span& span) {
    return {span.knot, knots[span.knot], knots[span.knot + 1]};
  }

  /// Halves the spans of a patch in the direction that lessens its error most. Returns false if
  /// they are as fine as they may be.
  bool divide(std::size_t i, Span& u, Span& v) const {
    const bool may_u = u.divisions < kMostDivisions;
    const bool may_v = v.divisions < kMostDivisions;
    if (!may_u && !may_v) return false;
    bool in_u = may_u;
    if (may_u && may_v) {
      const double with_u = patch_error(i, 2 * u.divisions, v.divisions);
      const double with_v = patch_error(i, u.divisions, 2 * v.divisions);
      in_u = with_u < with_v || (with_u == with_v && u.divisions <= v.divisions);
    }
    (in_u ? u : v).divisions *= 2;
    return true;
  }

  /// The control net of cell (a of n, b of m) of a patch.
  [[nodiscard]] Net cell(std::size_t i, std::size_t a, std::size_t n, std::size_t b,
                         std::size_t m) const {
    Net net = patches_[i];
    const auto part = [](std::size_t k, std::size_t of) {
      return static_cast<double>(k) / static_cast<double>(of);
    };
    for (std::size_t row = 0; row <= q_ && n > 1; ++row) {
      cut_bezier(net.data() + row * (p_ + 1), 1, p_, part(a, n), part(a + 1, n));
    }
    for (std::size_t column = 0; column <= p_ && m > 1; ++column) {
      cut_bezier(net.data() + column, p_ + 1, q_, part(b, m), part(b + 1, m));
    }
    return net;
  }

  [[nodiscard]] double patch_error(std::size_t i, std::size_t n, std::size_t m) const {
    double largest = 0.0;
    for (std::size_t b = 0; b < m; ++b) {
      for (std::size_t a = 0; a < n; ++a)
        largest = std::max(largest, cell_error(cell(i, a, n, b, m)));
    }
    return largest;
  }

  /// The bound in the header. The coefficients of products are those of raising the degree.
  [[nodiscard]] double cell_error(const Net& net) const {
    const std::size_t width = p_ + 1;
    const std::array<Point, 4> corners = {projected(net[0]), projected(net[p_]),
                                          projected(net[q_ * width]),
                                          projected(net[q_ * width + p_])};
    double least_weight = net[0][3];
    for (const WeightedPoint& point : net) least_weight = std::min(least_weight, point[3]);
    double largest = 0.0;
    for (std::size_t j = 0; j <= q_ + 1; ++j) {
      const double v = static_cast<double>(j) / static_cast<double>(q_ + 1);
      for (std::size_t i = 0; i <= p_ + 1; ++i) {
        const double u = static_cast<double>(i) / static_cast<double>(p_ + 1);
        Point sum{};
        for (std::size_t c = 0; c < 4; ++c) {
          const std::size_t a = c % 2;
          const std::size_t b = c / 2;
          const double factor = (a == 0 ? 1.0 - u : u) * (b == 0 ? 1.0 - v : v);
          if (i < a || j < b || i - a > p_ || j - b > q_) continue;
          const WeightedPoint& point = net[(j - b) * width + (i - a)];
          for (std::size_t k = 0; k < 3; ++k) {
            sum[k] += factor * (point[k] - point[3] * corners[c][k]);
          }
        }
        largest = std::max(largest, std::hypot(sum[0], sum[1], sum[2]));
      }
    }
    Point twist;
    for (std::size_t k = 0; k < 3; ++k) {
      twist[k] = corners[0][k] - corners[1][k] - corners[2][k] + corners[3][k];
    }
    return largest / least_weight + 0.25 * std::hypot(twist[0], twist[1], twist[2]);
  }

  /// Where grid line `line` is: its span, and the part of it.
  static std::pair<std::size_t, double> place(const std::vector<Span>& spans, std::size_t line) {
    std::size_t span = 0;
    while (span + 1 < spans.size() && line >= spans[span].divisions) {
      line -= spans[span++].divisions;
    }
    return {span, static_cast<double>(line) / static_cast<double>(spans[span].divisions)};
  }

  [[nodiscard]] Point point_at(std::size_t i, double u, double v) const {
    Net net = patches_[i];
    for (std::size_t row = 0; row <= q_; ++row) {
      cut_bezier(net.data() + row * (p_ + 1), 1, p_, u, u);
    }
    cut_bezier(net.data(), p_ + 1, q_, v, v);
    return projected(net[0]);
  }

  [[nodiscard]] FacetedSurface grid() const {
    FacetedSurface result;
    const std::size_t columns = total(u_spans_) + 1;
    const std::size_t rows = total(v_spans_) + 1;
    result.points.reserve(rows * columns);
    for (std::size_t row = 0; row < rows; ++row) {
      const auto [v_span, v] = place(v_spans_, row);
      for (std::size_t column = 0; column < columns; ++column) {
        const auto [u_span, u] = place(u_spans_, column);
        result.points.push_back(point_at(v_span * u_spans_.size() + u_span, u, v));
      }
    }
    for (std::size_t row = 0; row + 1 < rows; ++row) {
      for (std::size_t column = 0; column + 1 < columns; ++column) {
        const auto a = static_cast<std::uint32_t>(row * columns + column);
        const auto c = static_cast<std::uint32_t>((row + 1) * columns + column);
        result.triangles.push_back({a, a + 1, c + 1});
        result.triangles.push_back({a, c + 1, c});
      }
    }
    return result;
  }

  const std::size_t p_;
  const std::size_t q_;
  std::vector<Span> u_spans_;
  std::vector<Span> v_spans_;
  std::vector<Net> patches_;  ///< of all spans of u, for each span of v
};

/// Returns the fault of the knots of one direction; empty if they have none.
std::string fault_of_knots(const std::vector<double>& knots, std::size_t points) {
  if (knots.size() < points + 2) return "has too few knots";
  const std::size_t degree = knots.size() - points - 1;
  if (degree >= points) return "has too few control points for its knots";
  if (degree > kMostDegree) return "has a degree above " + std::to_string(kMostDegree);
  if (!std::ranges::all_of(knots, [](double t) { return std::isfinite(t); })) {
    return "has a knot that is no number";
  }
  return std::ranges::is_sorted(knots) ? "" : "has knots that decrease";
}

}  // namespace

std::string fault_of(const NurbsSurface& surface) {
  if (surface.u_points == 0 || surface.v_points == 0 ||
      surface.points.size() / surface.u_points != surface.v_points ||
      surface.points.size() % surface.u_points != 0) {
    return "has another number of control points than it says";
  }
  if (std::string fault = fault_of_knots(surface.u_knots, surface.u_points); !fault.empty()) {
    return fault;
  }
  if (std::string fault = fault_of_knots(surface.v_knots, surface.v_points); !fault.empty()) {
    return fault;
  }
  for (const WeightedPoint& point : surface.points) {
    if (!(point[3] > 0.0)) return "has a weight that is not positive";
    if (!std::ranges::all_of(point, [](double x) { return std::abs(x) <= 1e30; })) {
      return "has a control point that is no usable number";
    }
  }
  return {};
}

base::Result<FacetedGrid> grid_of(const NurbsSurface& surface, double tolerance,
                                  const GridSize& least) {
  if (std::string fault = fault_of(surface); !fault.empty()) return base::Failure{std::move(fault)};
  Facets facets(surface, surface.u_knots.size() - surface.u_points - 1,
                surface.v_knots.size() - surface.v_points - 1, least);
  if (facets.is_empty()) return base::Failure{"has knots without a span"};
  return facets.made(tolerance);
}

base::Result<FacetedSurface> facets_of(const NurbsSurface& surface, double tolerance) {
  base::Result<FacetedGrid> grid = grid_of(surface, tolerance);
  if (!grid) return base::Failure{std::move(grid.error)};
  return std::move(grid->facets);
}

}  // namespace camway::scene::surfaces
