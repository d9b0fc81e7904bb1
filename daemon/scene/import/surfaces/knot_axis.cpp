// SPDX-License-Identifier: MIT
#include "daemon/scene/import/surfaces/knot_axis.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace camway::scene::surfaces {

std::vector<double> KnotAxis::between(double low, double high) const {
  std::vector<double> result;
  const double first = period_ > 0.0 ? shift_of(low) : 0.0;
  for (double shift = first;; shift += period_) {
    for (std::size_t i = degree_; i <= points_; ++i) {
      const double knot = knots_[i] + shift;
      const bool is_new = result.empty() || result.back() < knot;
      if (knot > low && knot < high && is_new) result.push_back(knot);
    }
    const bool repeats = period_ > 0.0 && shift + period_ > shift;
    if (!repeats || knots_[points_] + shift >= high) return result;
  }
}

std::vector<double> KnotAxis::cuts(double low, double high) const {
  std::vector<double> result = between(low, high);
  result.insert(result.begin(), low);
  result.push_back(high);
  return result;
}

SpanPart KnotAxis::part(double low, double high) const {
  const double middle = 0.5 * (low + high);
  const double shift = period_ > 0.0 ? shift_of(middle) : 0.0;
  const auto first = knots_.begin() + static_cast<std::ptrdiff_t>(degree_);
  const auto last = knots_.begin() + static_cast<std::ptrdiff_t>(points_);
  auto knot = std::upper_bound(first, last, middle - shift);
  if (knot != first) --knot;
  // The span that is found at an end of the knots may have no length.
  while (knot != first && *knot == *(knot + 1)) --knot;
  while (knot + 1 != last && *knot == *(knot + 1)) ++knot;
  return {static_cast<std::size_t>(knot - knots_.begin()), low - shift, high - shift};
}

double KnotAxis::shift_of(double t) const {
  return std::floor((t - knots_[degree_]) / period_) * period_;
}

std::vector<std::array<double, 2>> hull_of(const PlaneCurve& curve, double low, double high) {
  const KnotAxis axis(curve.knots, curve.points.size(), curve.period);
  const std::vector<double> cuts = axis.cuts(low, high);
  std::vector<WeightedPoint> bezier(axis.degree() + 1);
  std::vector<std::array<double, 2>> hull;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    bezier_of_span(curve.points, curve.knots, axis.degree(), axis.part(cuts[i], cuts[i + 1]),
                   bezier);
    for (const WeightedPoint& point : bezier) {
      const Point at = projected(point);
      hull.push_back({at[0], at[1]});
    }
  }
  return hull;
}

}  // namespace camway::scene::surfaces
