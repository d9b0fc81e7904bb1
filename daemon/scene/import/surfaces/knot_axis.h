// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "daemon/scene/import/surfaces/bezier_net.h"

namespace camway::scene::surfaces {

/// The knots of one direction of a surface, or of a curve. Keeps a reference to the knots.
class KnotAxis {
 public:
  /// A period of 0 says that nothing repeats; else the knots cover one. Requires knots without a
  /// fault (`fault_of`).
  KnotAxis(const std::vector<double>& knots, std::size_t points, double period)
      : knots_(knots), points_(points), degree_(knots.size() - points - 1), period_(period) {}

  [[nodiscard]] std::size_t degree() const { return degree_; }

  /// The knots strictly between two parameters, each once, in order.
  [[nodiscard]] std::vector<double> between(double low, double high) const;

  /// `low`, the knots between, `high`.
  [[nodiscard]] std::vector<double> cuts(double low, double high) const;

  /// The span in which [low, high] is, moved by periods; beyond the ends the first and the last.
  /// Requires that no knot is strictly between them.
  [[nodiscard]] SpanPart part(double low, double high) const;

 private:
  [[nodiscard]] double shift_of(double t) const;

  const std::vector<double>& knots_;
  std::size_t points_;
  std::size_t degree_;
  double period_;
};

/// A plane B-spline curve with positive weights, (w x, w y, 0, w).
struct PlaneCurve {
  std::vector<WeightedPoint> points;
  std::vector<double> knots;
  double period = 0.0;
};

/// Control points of the part [low, high] of a curve: the curve is in their convex hull (Farin
/// 2002, section 4.2). Requires knots and weights without a fault.
std::vector<std::array<double, 2>> hull_of(const PlaneCurve& curve, double low, double high);

}  // namespace camway::scene::surfaces
