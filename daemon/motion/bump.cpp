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

struct Span {
  double t0_s;
  double t1_s;
};

/// Where `piece` is cut: its ends, and what knots lie well inside.
std::vector<double> cuts_s(const CubicPiece& piece, std::span<const BumpRow> rows) {
  std::vector<double> inner_s;
  double same_s = std::numeric_limits<double>::infinity();
  for (const BumpRow& row : rows) {
    same_s = std::min(same_s, kSameKnot * row.knots.spacing_s());
    const int last = row.first + static_cast<int>(row.bumps.size()) + 1;
    for (int k = row.first - 2; k <= last; ++k) {
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

/// Bézier points over `span` of bump `index` of `knots`, or zeros outside its support. The span
/// lies within one interval of the knots, but for `kSameKnot`.
std::array<double, 4> bump_points(const KnotRow& knots, int index, const Span& span) {
  const double middle_s = 0.5 * (span.t0_s + span.t1_s);
  for (int j = 0; j < 4; ++j) {
    const double from_s = knots.knot_s(index - 2 + j);
    const double to_s = knots.knot_s(index - 1 + j);
    if (middle_s < from_s || middle_s >= to_s) continue;
    const auto parameter = [&](double time_s) {
      // Exact at the knots: there the neighbours have to agree, and the ends to be zero.
      if (time_s == to_s) return 1.0;
      return std::clamp((time_s - from_s) / (to_s - from_s), 0.0, 1.0);
    };
    return bezier::sub_curve(kBumpPieces[static_cast<std::size_t>(j)], parameter(span.t0_s),
                             parameter(span.t1_s));
  }
  return {};
}

void add(CubicPiece& piece, const BumpRow& row) {
  for (std::size_t i = 0; i < row.bumps.size(); ++i) {
    const std::array<double, 4> weights =
        bump_points(row.knots, row.first + static_cast<int>(i), {piece.t0_s, piece.t1_s});
    for (std::size_t k = 0; k < weights.size(); ++k) {
      if (weights[k] == 0.0) continue;
      piece.position[k] += weights[k] * row.bumps[i].position;
      piece.image[k] += weights[k] * row.bumps[i].image;
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
