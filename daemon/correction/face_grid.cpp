// SPDX-License-Identifier: MIT
#include "daemon/correction/face_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "daemon/correction/surface_parity.h"
#include "daemon/geometry/rounding.h"

namespace camway::correction {
namespace {

using geometry::Box;
using geometry::Triangle;
using geometry::Vec3;

/// In units of rounding of the largest coordinate of triangle and face. The fraction along an edge
/// has 3u of its length, at most twice that coordinate, product and sum 3u more, clipping to a row
/// the same again: 18u; the bounds of a row 4u, the number of a cell 3u. What is left covers the
/// border of the face, from which the sum of all steps may differ by 3u: no surface is that near to
/// a cell that is not marked, so what lies between is on the same side as the cell.
constexpr double kSectionRounding = 64.0;

/// A bounding box of cells, made of sums of doubles: 4u each; this is more than a thousand times
/// that.
constexpr double kWidthRounding = 1e-12;

void clip_to_row(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double low, double high,
                 double& from, double& to) {
  const auto add = [&](double u) {
    from = std::min(from, u);
    to = std::max(to, u);
  };
  for (const auto& p : {a, b}) {
    if (p.y() >= low && p.y() <= high) add(p.x());
  }
  for (const double v : {low, high}) {
    if ((a.y() < v) == (b.y() < v)) continue;
    add(a.x() + (b.x() - a.x()) * ((v - a.y()) / (b.y() - a.y())));
  }
}

}  // namespace

FaceGrid::FaceGrid(const Box& box, int axis, double at, double cell_m)
    : axis_(axis), at_(at), axes_{(axis + 1) % 3, (axis + 2) % 3} {
  for (std::size_t k = 0; k < 2; ++k) {
    const double extent = box.max()[axes_[k]] - box.min()[axes_[k]];
    count_[k] = std::max(1, static_cast<int>(std::ceil(extent / cell_m)));
    low_[k] = box.min()[axes_[k]];
    step_[k] = extent / count_[k];
  }
  blocked_.assign(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]), 0);
  largest_m_ = std::max(box.min().lpNorm<Eigen::Infinity>(), box.max().lpNorm<Eigen::Infinity>());
}

int FaceGrid::cell_of(int k, double x) const {
  const std::size_t i = static_cast<std::size_t>(k);
  // Clamped to just outside the face before it becomes an integer.
  return static_cast<int>(
      std::floor(std::clamp((x - low_[i]) / step_[i], -2.0, static_cast<double>(count_[i]) + 1.0)));
}

Vec3 FaceGrid::middle_of(int u, int v) const {
  Vec3 result;
  result[axis_] = at_;
  result[axes_[0]] = low_[0] + (u + 0.5) * step_[0];
  result[axes_[1]] = low_[1] + (v + 0.5) * step_[1];
  return result;
}

FaceGrid::Section FaceGrid::section(const Triangle& triangle) const {
  Section result;
  double largest_m = largest_m_;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& a = triangle[k];
    const Vec3& b = triangle[(k + 1) % 3];
    const Point flat_a(a[axes_[0]], a[axes_[1]]);
    const Point flat_b(b[axes_[0]], b[axes_[1]]);
    largest_m = std::max(largest_m, a.lpNorm<Eigen::Infinity>());
    if (a[axis_] == at_) result.points.push_back(flat_a);
    if ((a[axis_] < at_ && b[axis_] > at_) || (a[axis_] > at_ && b[axis_] < at_)) {
      const double fraction = (at_ - a[axis_]) / (b[axis_] - a[axis_]);
      result.points.push_back(flat_a + fraction * (flat_b - flat_a));
    }
  }
  result.margin_m = kSectionRounding * geometry::kUnitRoundoff * largest_m;
  return result;
}

void FaceGrid::mark(const Section& section, const Window& window,
                    std::vector<std::uint8_t>& touched) const {
  const std::vector<Point>& points = section.points;
  if (points.empty()) return;
  double bottom = points[0].y();
  double top = bottom;
  for (const Point& p : points) {
    bottom = std::min(bottom, p.y());
    top = std::max(top, p.y());
  }
  const int last = std::min(window.v1, cell_of(1, top + section.margin_m));
  for (int v = std::max(window.v0, cell_of(1, bottom - section.margin_m)); v <= last; ++v) {
    double from = std::numeric_limits<double>::infinity();
    double to = -from;
    for (const Point& a : points) {
      for (const Point& b : points) {
        clip_to_row(a, b, low_[1] + v * step_[1] - section.margin_m,
                    low_[1] + (v + 1) * step_[1] + section.margin_m, from, to);
      }
    }
    if (from > to) continue;
    const int end = std::min(window.u1, cell_of(0, to + section.margin_m));
    for (int u = std::max(window.u0, cell_of(0, from - section.margin_m)); u <= end; ++u) {
      touched[window.at(u, v)] = 1;
    }
  }
}

std::size_t FaceGrid::block(const scene::Mesh& mesh, std::span<const std::uint32_t> triangles,
                            bool body_is_odd) {
  Box bounds;
  for (const std::uint32_t t : triangles) bounds.extend(geometry::bounds(mesh.triangle(t)));
  if (bounds.isEmpty() || bounds.min()[axis_] > at_ || bounds.max()[axis_] < at_) {
    return triangles.size();
  }
  const Window window{.u0 = std::max(0, cell_of(0, bounds.min()[axes_[0]])),
                      .v0 = std::max(0, cell_of(1, bounds.min()[axes_[1]])),
                      .u1 = std::min(count_[0] - 1, cell_of(0, bounds.max()[axes_[0]])),
                      .v1 = std::min(count_[1] - 1, cell_of(1, bounds.max()[axes_[1]]))};
  if (window.u0 > window.u1 || window.v0 > window.v1) return triangles.size();
  std::vector<std::uint8_t> done(
      window.width() * static_cast<std::size_t>(window.v1 - window.v0 + 1), 0);
  for (const std::uint32_t t : triangles) mark(section(mesh.triangle(t)), window, done);

  std::size_t looked_at = done.size() + triangles.size();
  for (int v = window.v0; v <= window.v1; ++v) {
    for (int u = window.u0; u <= window.u1; ++u) {
      if (done[window.at(u, v)] != 0) continue;
      const std::vector<Cell> part = take_part(window, {u, v}, done);
      looked_at += triangles.size();
      // No triangle meets any of these cells, so all of them are on one side.
      const std::optional<bool> odd = is_odd(middle_of(u, v), mesh, triangles);
      if (!odd || *odd == body_is_odd) continue;
      for (const auto& [part_u, part_v] : part) blocked_[cell(part_u, part_v)] = 1;
    }
  }
  return looked_at;
}

std::vector<FaceGrid::Cell> FaceGrid::take_part(const Window& window, Cell first,
                                                std::vector<std::uint8_t>& done) {
  std::vector<Cell> part = {first};
  done[window.at(first.first, first.second)] = 1;
  for (std::size_t i = 0; i < part.size(); ++i) {
    const auto [u, v] = part[i];
    for (const auto& [du, dv] : {Cell(-1, 0), Cell(1, 0), Cell(0, -1), Cell(0, 1)}) {
      const Cell next(u + du, v + dv);
      if (next.first < window.u0 || next.first > window.u1 || next.second < window.v0 ||
          next.second > window.v1) {
        continue;
      }
      if (std::exchange(done[window.at(next.first, next.second)], std::uint8_t{1}) == 0) {
        part.push_back(next);
      }
    }
  }
  return part;
}

std::optional<double> FaceGrid::widest_hole_m() const {
  std::vector<std::uint8_t> done = blocked_;
  std::vector<Cell> hole;
  double widest_m = 0.0;
  for (int v0 = 0; v0 < count_[1]; ++v0) {
    for (int u0 = 0; u0 < count_[0]; ++u0) {
      if (done[cell(u0, v0)] != 0) continue;
      std::array<int, 4> range = {u0, u0, v0, v0};
      hole.assign(1, {u0, v0});
      done[cell(u0, v0)] = 1;
      while (!hole.empty()) {
        const auto [u, v] = hole.back();
        hole.pop_back();
        if (u == 0 || v == 0 || u == count_[0] - 1 || v == count_[1] - 1) return std::nullopt;
        range = {std::min(range[0], u), std::max(range[1], u), std::min(range[2], v),
                 std::max(range[3], v)};
        // Cells are closed: those that share just a corner are connected.
        for (int dv = -1; dv <= 1; ++dv) {
          for (int du = -1; du <= 1; ++du) {
            if (std::exchange(done[cell(u + du, v + dv)], std::uint8_t{1}) == 0) {
              hole.emplace_back(u + du, v + dv);
            }
          }
        }
      }
      widest_m = std::max(widest_m, std::hypot((range[1] - range[0] + 1) * step_[0],
                                               (range[3] - range[2] + 1) * step_[1]));
    }
  }
  return widest_m * (1.0 + kWidthRounding);
}

}  // namespace camway::correction
