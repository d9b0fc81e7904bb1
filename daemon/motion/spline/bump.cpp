// SPDX-License-Identifier: MIT
#include "daemon/motion/spline/bump.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "daemon/motion/path/bezier.h"

namespace camway::motion {

namespace {

using geometry::Vec3;
using geometry::Vec4;

/// The times where `piece` is split: its ends and the knots inside.
std::vector<double> cuts_s(const CubicPiece& piece, std::span<const BumpRow> rows) {
  std::vector<double> cuts = {piece.t0_s};
  for (const BumpRow& row : rows) {
    const int last = row.first + static_cast<int>(row.bumps.size()) + 1;
    // Only the knots within the piece, and one step more on either side, as knots are not quite
    // equidistant.
    const auto steps_to = [&](double time_s) {
      return static_cast<int>(std::clamp((time_s - row.knots.begin_s) / row.knots.spacing_s(),
                                         row.first - 3.0, last + 1.0));
    };
    const bool is_even = !row.knots.given_s;
    const int from = std::max(row.first - 2, is_even ? steps_to(piece.t0_s) - 1 : row.first - 2);
    const int to = std::min(last, is_even ? steps_to(piece.t1_s) + 2 : last);
    for (int k = from; k <= to; ++k) {
      const double knot_s = row.knots.knot_s(k);
      if (piece.t0_s < knot_s && knot_s < piece.t1_s) cuts.push_back(knot_s);
    }
  }
  std::ranges::sort(cuts);
  // Not std::ranges::unique: Clang 14 cannot compile that of GCC 12's library.
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
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

/// A row with its bumps evaluated, as each reaches over several pieces.
struct EvaluatedRow {
  const BumpRow& row;
  std::vector<KnotBump> bumps;

  explicit EvaluatedRow(const BumpRow& bump_row) : row(bump_row) {
    const int end = row.first + static_cast<int>(row.bumps.size());
    for (int k = row.first; k < end; ++k) bumps.push_back(row.knots.bump(k));
  }
};

/// Adds a row to `piece`, which lies between two consecutive knots.
void add(CubicPiece& piece, const EvaluatedRow& evaluated) {
  const BumpRow& row = evaluated.row;
  const double middle_s = 0.5 * (piece.t0_s + piece.t1_s);
  // Outside the supports; returning here also keeps the knot index within int.
  if (middle_s <= row.begin_s() || middle_s >= row.end_s()) return;
  const int before = knot_before(row.knots, middle_s);
  const double from_s = row.knots.knot_s(before);
  const double to_s = row.knots.knot_s(before + 1);
  const auto parameter = [&](double time_s) {
    // Exact at the knots, where neighbours must agree and the ends must be zero.
    if (time_s == to_s) return 1.0;
    return std::clamp((time_s - from_s) / (to_s - from_s), 0.0, 1.0);
  };
  const double u0 = parameter(piece.t0_s);
  const double u1 = parameter(piece.t1_s);
  const int end = row.first + static_cast<int>(row.bumps.size());
  for (int k = std::max(row.first, before - 1); k < std::min(end, before + 3); ++k) {
    const auto at = static_cast<std::size_t>(k - row.first);
    const CubicPoint& bump = row.bumps[at];
    const auto part = static_cast<std::size_t>(before - (k - 2));
    const std::array<double, 4> weights =
        bezier::sub_curve(evaluated.bumps[at].pieces[part], u0, u1);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      piece.position[i] += weights[i] * bump.position;
      piece.image[i] += weights[i] * bump.image;
    }
  }
}

}  // namespace

CubicPath with_bumps(const CubicPath& path, std::span<const BumpRow> rows) {
  double begin_s = std::numeric_limits<double>::infinity();
  double end_s = -begin_s;
  for (const BumpRow& row : rows) {
    begin_s = std::min(begin_s, row.begin_s());
    end_s = std::max(end_s, row.end_s());
  }
  const std::vector<EvaluatedRow> evaluated(rows.begin(), rows.end());
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
      for (const EvaluatedRow& row : evaluated) add(part, row);
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
