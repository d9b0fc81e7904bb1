// SPDX-License-Identifier: MIT
#include "daemon/motion/bump.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "daemon/motion/bezier.h"

namespace camway::motion {

namespace {

using geometry::Vec3;
using geometry::Vec4;

/// Bézier points of the uniform cubic B-spline on the four knot intervals of its support (Farin
/// 2002, section 8.6).
constexpr std::array<std::array<double, 4>, 4> kBumpPieces = {{
    {0.0, 0.0, 0.0, 1.0 / 6.0},
    {1.0 / 6.0, 2.0 / 6.0, 4.0 / 6.0, 4.0 / 6.0},
    {4.0 / 6.0, 4.0 / 6.0, 2.0 / 6.0, 1.0 / 6.0},
    {1.0 / 6.0, 0.0, 0.0, 0.0},
}};

/// Where `piece` is cut: its ends, and what knots lie well inside.
std::vector<double> cuts_s(const CubicPiece& piece, std::span<const BumpRow> rows) {
  std::vector<double> inner_s;
  double same_s = std::numeric_limits<double>::infinity();
  for (const BumpRow& row : rows) {
    same_s = std::min(same_s, kSameKnot * row.knots.spacing_s());
    const int last = row.first + static_cast<int>(row.bumps.size()) + 1;
    // Only those between: a step more on either side makes up for rounding.
    const auto steps_to = [&](double time_s) {
      return static_cast<int>(std::clamp((time_s - row.knots.begin_s) / row.knots.spacing_s(),
                                         row.first - 3.0, last + 1.0));
    };
    const int from = std::max(row.first - 2, steps_to(piece.t0_s) - 1);
    const int to = std::min(last, steps_to(piece.t1_s) + 2);
    for (int k = from; k <= to; ++k) {
      const double knot_s = row.knots.knot_s(k);
      if (knot_s - piece.t0_s > same_s && piece.t1_s - knot_s > same_s) inner_s.push_back(knot_s);
    }
  }
  std::ranges::sort(inner_s);
  std::vector<double> cuts = {piece.t0_s};
  for (const double knot_s : inner_s) {
    if (knot_s - cuts.back() > same_s) cuts.push_back(knot_s);
  }
  cuts.push_back(piece.t1_s);
  return cuts;
}

/// The knot at or before `time_s`, and before the next one.
int knot_before(const KnotRow& knots, double time_s) {
  int k = static_cast<int>(std::floor((time_s - knots.begin_s) / knots.spacing_s()));
  while (knots.knot_s(k) > time_s) --k;
  while (knots.knot_s(k + 1) <= time_s) ++k;
  return k;
}

/// Adds what `row` is on `piece`, which lies between two knots that follow each other, but for
/// `kSameKnot`.
void add(CubicPiece& piece, const BumpRow& row) {
  const double middle_s = 0.5 * (piece.t0_s + piece.t1_s);
  // So far away, in spacings, as no number of a knot can say.
  if (middle_s <= row.begin_s() || middle_s >= row.end_s()) return;
  const int before = knot_before(row.knots, middle_s);
  const double from_s = row.knots.knot_s(before);
  const double to_s = row.knots.knot_s(before + 1);
  const auto parameter = [&](double time_s) {
    // Exact at the knots: there the neighbours have to agree, and the ends to be zero.
    if (time_s == to_s) return 1.0;
    return std::clamp((time_s - from_s) / (to_s - from_s), 0.0, 1.0);
  };
  const double u0 = parameter(piece.t0_s);
  const double u1 = parameter(piece.t1_s);
  const int end = row.first + static_cast<int>(row.bumps.size());
  for (int k = std::max(row.first, before - 1); k < std::min(end, before + 3); ++k) {
    const CubicPoint& bump = row.bumps[static_cast<std::size_t>(k - row.first)];
    const auto part = static_cast<std::size_t>(before - (k - 2));
    const std::array<double, 4> weights = bezier::sub_curve(kBumpPieces[part], u0, u1);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      piece.position[i] += weights[i] * bump.position;
      piece.image[i] += weights[i] * bump.image;
    }
  }
}

}  // namespace

double KnotRow::knot_s(int index) const {
  if (index == 0) return begin_s;
  if (index == count) return end_s;
  return begin_s + (end_s - begin_s) * (static_cast<double>(index) / count);
}

double bump_value(double knots) {
  const double a = std::abs(knots);
  if (a >= 2.0) return 0.0;
  if (a >= 1.0) return (2.0 - a) * (2.0 - a) * (2.0 - a) / 6.0;
  return 2.0 / 3.0 - a * a + 0.5 * a * a * a;
}

CubicPath with_bumps(const CubicPath& path, std::span<const BumpRow> rows) {
  double begin_s = std::numeric_limits<double>::infinity();
  double end_s = -begin_s;
  for (const BumpRow& row : rows) {
    begin_s = std::min(begin_s, row.begin_s());
    end_s = std::max(end_s, row.end_s());
  }
  CubicPath result{path.reference, {}};
  for (const CubicPiece& piece : path.pieces) {
    if (piece.t1_s <= begin_s || piece.t0_s >= end_s) {
      result.pieces.push_back(piece);
      continue;
    }
    const std::vector<double> cuts = cuts_s(piece, rows);
    const auto parameter = [&](double time_s) {
      if (time_s == piece.t1_s) return 1.0;
      return (time_s - piece.t0_s) / (piece.t1_s - piece.t0_s);
    };
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const double u0 = parameter(cuts[i]);
      const double u1 = parameter(cuts[i + 1]);
      CubicPiece part{cuts[i], cuts[i + 1], bezier::sub_curve(piece.position, u0, u1),
                      bezier::sub_curve(piece.image, u0, u1)};
      for (const BumpRow& row : rows) add(part, row);
      const bool joins = !result.pieces.empty() && result.pieces.back().t1_s == part.t0_s;
      if (joins && i > 0) {
        part.position[0] = result.pieces.back().position[3];
        part.image[0] = result.pieces.back().image[3];
      }
      result.pieces.push_back(part);
    }
  }
  return result;
}

}  // namespace camway::motion
