// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/contact_rows.h"

#include <algorithm>
#include <limits>

#include "daemon/geometry/triangle_distance.h"
#include "daemon/motion/path/quaternion.h"

namespace camway::correction {

namespace {

using geometry::Triangle;
using geometry::Vec3;
using geometry::Vec4;
using Turns = Eigen::Matrix<double, 3, 4>;

/// Rotation vectors (axis times radians) of unit steps of the image, in the world frame.
Turns turns_of(const Vec4& reference, const Vec4& image) {
  using motion::quaternion::conjugate;
  using motion::quaternion::multiply;
  const Vec4 q = multiply(reference, multiply(image, image)) / image.squaredNorm();
  Turns turns;
  for (Eigen::Index k = 0; k < 4; ++k) {
    const Vec4 unit = Vec4::Unit(k);
    const Vec4 step = multiply(reference, multiply(image, unit) + multiply(unit, image));
    // The real part changes the length of q and is no rotation.
    turns.col(k) = 2.0 / image.squaredNorm() * multiply(step, conjugate(q)).tail<3>();
  }
  return turns;
}

/// Keeps the tightest of the rows from `first` on, in their order.
void keep_tightest(std::vector<ContactRow>& rows, std::size_t first) {
  constexpr std::size_t kMost = 48;  // rows per obstacle: more than a box has
  if (rows.size() - first <= kMost) return;
  std::vector<double> rooms_m;
  for (std::size_t i = first; i < rows.size(); ++i) rooms_m.push_back(rows[i].room_m);
  std::ranges::nth_element(rooms_m, rooms_m.begin() + kMost - 1);
  const double most_m = rooms_m[kMost - 1];
  std::size_t kept = first;
  for (std::size_t i = first; i < rows.size() && kept < first + kMost; ++i) {
    if (rows[i].room_m <= most_m) rows[kept++] = rows[i];
  }
  rows.resize(kept);
}

/// The body at a pose, and the rotations that steps of its image make.
struct Place {
  collision::Probe& probe;
  motion::Pose pose;
  Turns turns;
  double lever_m;

  /// The row for a vertex of the body at `vertex_W`, which is `room_m` beyond the plane.
  [[nodiscard]] ContactRow row(std::uint32_t obstacle, std::size_t vertex, const Vec3& vertex_W,
                               const Vec3& away_W, double room_m) const {
    ContactRow row;
    row.room_m = room_m;
    row.triangle = obstacle;
    row.vertex = vertex;
    row.direction.head<3>() = away_W;
    row.direction.tail<4>() =
        turns.transpose() * (vertex_W - pose.position).cross(away_W) / lever_m;
    return row;
  }
};

/// Most rows that are made for an obstacle and a body of many triangles, the nearest ones about
/// first: enough to choose the tightest from.
constexpr std::size_t kMostOfMany = 256;

void add_rows_of_triangle(std::uint32_t index, double keep_m, double horizon_m, const Place& place,
                          std::vector<ContactRow>& rows) {
  const std::size_t first = rows.size();
  // A part has no row where its distance exceeds the horizon.
  const double within_m = std::max(0.0, keep_m + horizon_m);
  place.probe.for_each_pair_with(
      index, within_m, [&](std::uint32_t k, const Triangle& part, const Triangle& obstacle) {
        const geometry::TriangleGap gap =
            geometry::triangle_gap(obstacle, part, std::numeric_limits<double>::infinity());
        const double length = gap.direction.norm();
        if (!(length > 0.0)) return true;
        const Vec3 away_W = gap.direction / length;
        double plane_m = -std::numeric_limits<double>::infinity();
        for (const Vec3& vertex : obstacle) plane_m = std::max(plane_m, away_W.dot(vertex));
        for (std::size_t i = 0; i < 3; ++i) {
          const double room_m = away_W.dot(part[i]) - plane_m - keep_m;
          if (room_m <= horizon_m)
            rows.push_back(place.row(index, 3 * std::size_t{k} + i, part[i], away_W, room_m));
        }
        return place.probe.body().tree() == nullptr || rows.size() - first < kMostOfMany;
      });
}

void add_rows_of_side(std::uint32_t number, const FreeSpace& space, double horizon_m,
                      const Place& place, std::vector<ContactRow>& rows) {
  const std::size_t first = rows.size();
  const std::size_t side = collision::Obstacles::side_of(number);
  const Vec3 inward_W = geometry::Bounds::inward(side);
  const double ball_m = space.body().ball_radius_m();
  place.probe.for_each_vertex(side, horizon_m + ball_m, [&](std::size_t vertex, const Vec3& at_W) {
    const double room_m = space.obstacles().bounds.depth_m(side, at_W) - ball_m;
    if (room_m <= horizon_m) rows.push_back(place.row(number, vertex, at_W, inward_W, room_m));
    return place.probe.body().tree() == nullptr || rows.size() - first < kMostOfMany;
  });
}

}  // namespace

void add_contact_rows(FreeSpace& space, const StackedPlace& at,
                      std::span<const std::uint32_t> obstacles, double horizon_m,
                      std::vector<ContactRow>& rows) {
  const motion::CubicPoint cubic = unstacked(at.point, at.lever_m);
  const motion::Pose pose = motion::pose_of(at.reference, cubic);
  const Turns turns = at.may_turn ? turns_of(at.reference, cubic.image) : Turns(Turns::Zero());
  const Place place{space.placed(pose), pose, turns, at.lever_m};
  for (const std::uint32_t number : obstacles) {
    const std::size_t first_row = rows.size();
    if (collision::Obstacles::is_side(number)) {
      add_rows_of_side(number, space, horizon_m, place, rows);
    } else {
      add_rows_of_triangle(number, space.keep_m(), horizon_m, place, rows);
    }
    keep_tightest(rows, first_row);
  }
}

}  // namespace camway::correction
