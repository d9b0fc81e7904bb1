// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/other_sides.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "daemon/motion/path/bezier.h"
#include "tests/bench/fidelity/changed_ranges.h"

namespace camway::bench {

namespace {

using geometry::Vec3;
using motion::CubicPath;
using motion::CubicPiece;

constexpr double kGrowthOfOffset = std::numbers::sqrt2;

/// The part of `original` at the time of `piece`.
std::array<Vec3, 4> position_before(const CubicPath& original, const CubicPiece& piece) {
  const double middle_s = 0.5 * (piece.t0_s + piece.t1_s);
  const auto later = std::ranges::upper_bound(original.pieces, middle_s, {}, &CubicPiece::t0_s);
  const CubicPiece& before = *std::prev(later);
  const double duration_s = before.t1_s - before.t0_s;
  return motion::bezier::sub_curve(before.position, (piece.t0_s - before.t0_s) / duration_s,
                                   (piece.t1_s - before.t0_s) / duration_s);
}

/// The path with its offset in a range multiplied by a matrix.
CubicPath with_offset_times(const Eigen::Matrix3d& matrix, const CubicPath& original,
                            const CubicPath& path, const TimeRange& range) {
  CubicPath changed = path;
  for (CubicPiece& piece : changed.pieces) {
    if (piece.t1_s <= range.begin_s || piece.t0_s >= range.end_s) continue;
    const std::array<Vec3, 4> before = position_before(original, piece);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Vec3 offset = matrix * (piece.position[i] - before[i]);
      piece.position[i] = before[i] + offset;
    }
  }
  return changed;
}

/// The direction of travel in a range; the path may stand still there.
Vec3 direction_of_travel(const CubicPath& original, const TimeRange& range) {
  const Vec3 way = original.at(range.end_s).position - original.at(range.begin_s).position;
  return way.norm() > 0.0 ? Vec3(way.normalized()) : Vec3(Vec3::UnitY());
}

/// The path on the side at `angle_rad`, enlarged until it is free.
std::optional<CubicPath> on_side(const Shot& shot, const CubicPath& path, const TimeRange& range,
                                 double angle_rad) {
  const Vec3 axis = direction_of_travel(shot.interpolated(), range);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
  for (double factor = 1.0; factor <= kMostEnlarged; factor *= kGrowthOfOffset) {
    const Eigen::Matrix3d matrix = factor * turn;
    CubicPath other = with_offset_times(matrix, shot.interpolated(), path, range);
    if (shot.certified_clearance_m(other.path())) return other;
  }
  return std::nullopt;
}

}  // namespace

std::vector<CubicPath> other_sides(const Shot& shot, const CubicPath& path) {
  std::vector<CubicPath> found;
  for (const TimeRange& range : changed_ranges(path, shot.interpolated())) {
    for (int side = 1; side < kSides; ++side) {
      const double angle_rad = 2.0 * std::numbers::pi * side / kSides;
      std::optional<CubicPath> other = on_side(shot, path, range, angle_rad);
      if (other) found.push_back(*std::move(other));
    }
  }
  return found;
}

}  // namespace camway::bench
