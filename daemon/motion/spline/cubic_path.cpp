// SPDX-License-Identifier: MIT
#include "daemon/motion/spline/cubic_path.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "daemon/motion/path/bezier.h"
#include "daemon/motion/path/quaternion.h"
#include "daemon/motion/spline/cubic_spline.h"

namespace camway::motion {

using geometry::Vec3;
using geometry::Vec4;

CubicPath cubic_path(const Vec4& reference, std::span<const double> times_s,
                     std::span<const Vec3> positions, std::span<const Vec3> velocities_m_per_s,
                     std::span<const Vec4> images, std::span<const Vec4> image_rates_per_s) {
  CubicPath path{reference, {}};
  for (std::size_t i = 0; i + 1 < times_s.size(); ++i) {
    path.pieces.push_back({times_s[i], times_s[i + 1],
                           spline_piece<Vec3>(times_s, positions, velocities_m_per_s, i),
                           spline_piece<Vec4>(times_s, images, image_rates_per_s, i)});
  }
  return path;
}

Pose pose_of(const Vec4& reference, const CubicPoint& point) {
  const Vec4 q = quaternion::multiply(reference, quaternion::multiply(point.image, point.image));
  return {point.position, geometry::from_wxyz(q / q.norm())};
}

const CubicPiece& CubicPath::piece_at(double time_s) const {
  const auto later = std::ranges::upper_bound(pieces, time_s, {}, &CubicPiece::t0_s);
  return later == pieces.begin() ? *later : *std::prev(later);
}

CubicPoint CubicPath::second_derivative(double time_s) const {
  const CubicPiece& piece = piece_at(time_s);
  const double duration_s = piece.t1_s - piece.t0_s;
  const double u = std::clamp((time_s - piece.t0_s) / duration_s, 0.0, 1.0);
  const double scale = 6.0 / (duration_s * duration_s);
  const auto& p = piece.position;
  const auto& x = piece.image;
  return {scale * ((1.0 - u) * (p[0] - 2.0 * p[1] + p[2]) + u * (p[1] - 2.0 * p[2] + p[3])),
          scale * ((1.0 - u) * (x[0] - 2.0 * x[1] + x[2]) + u * (x[1] - 2.0 * x[2] + x[3]))};
}

CubicPoint point_at(const CubicPiece& piece, double time_s) {
  const double u = std::clamp((time_s - piece.t0_s) / (piece.t1_s - piece.t0_s), 0.0, 1.0);
  return {bezier::value_at(piece.position, u), bezier::value_at(piece.image, u)};
}

CubicPoint CubicPath::at(double time_s) const { return point_at(piece_at(time_s), time_s); }

Pose CubicPath::pose(double time_s) const { return pose_of(reference, at(time_s)); }

CubicPath CubicPath::around(double t_begin_s, double t_end_s) const {
  CubicPath part{reference, {}};
  for (auto piece = std::ranges::upper_bound(pieces, t_begin_s, {}, &CubicPiece::t1_s);
       piece != pieces.end() && piece->t0_s < t_end_s; ++piece) {
    part.pieces.push_back(*piece);
  }
  return part;
}

void CubicPath::replace(const CubicPath& part) {
  const auto first = std::ranges::lower_bound(pieces, part.begin_s(), {}, &CubicPiece::t0_s);
  const auto last = std::ranges::lower_bound(pieces, part.end_s(), {}, &CubicPiece::t0_s);
  assert(first != pieces.end() && first->t0_s == part.begin_s());
  assert(std::prev(last)->t1_s == part.end_s());
  // Moves the pieces behind `part` at most once, as a path may be long.
  const auto common = std::min(last - first, std::ssize(part.pieces));
  std::copy_n(part.pieces.begin(), common, first);
  const auto at = pieces.erase(first + common, last);
  pieces.insert(at, part.pieces.begin() + common, part.pieces.end());
}

Path CubicPath::path() const {
  std::vector<Segment> segments;
  segments.reserve(pieces.size());
  for (const CubicPiece& piece : pieces) {
    segments.push_back(
        {piece.t0_s, piece.t1_s, piece.position, orientation_of(reference, piece.image)});
  }
  return Path(std::move(segments));
}

}  // namespace camway::motion
