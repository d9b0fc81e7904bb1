// SPDX-License-Identifier: MIT
#include "tests/bench/narrow_bodies.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::bench {

namespace {

using geometry::Quat;
using geometry::Vec3;
using testing::add_cuboid;
using Piece = std::vector<Vec3>;

constexpr double kDuration_s = 12.0;
constexpr int kRingParts = 16;
constexpr int kPoleParts = 24;
constexpr double kRing_m = 0.5;       // radius of the ring's middle line
constexpr double kRingHalf_m = 0.08;  // half of its width and height
constexpr double kPole_m = 2.0;       // height

Piece cuboid(const Vec3& center, const Vec3& size_m) {
  Piece piece;
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      for (const double z : {-0.5, 0.5}) {
        piece.push_back(center + Vec3(x, y, z).cwiseProduct(size_m));
      }
    }
  }
  return piece;
}

/// A body, and the size of its profile across the x axis.
struct Mover {
  motion::ConvexShape shape;
  double width_m;
  double height_m;
};

Mover mover(std::size_t body) {
  switch (body) {
    case 0:
      return {{{cuboid({0, 0, 0}, {1.2, 0.5, 0.3})}}, 0.5, 0.3};
    case 1:
      return {
          {{cuboid({0, 0, 0}, {1.2, 0.25, 0.25}), cuboid({0.475, 0.35, 0}, {0.25, 0.45, 0.25})}},
          0.7,
          0.25};
    case 2: {
      Mover table{{{cuboid({0, 0, 0}, {1.4, 0.8, 0.05})}}, 0.8, 0.75};
      for (const double x : {-0.65, 0.65}) {
        for (const double y : {-0.35, 0.35}) {
          table.shape.pieces_C.push_back(cuboid({x, y, -0.375}, {0.06, 0.06, 0.7}));
        }
      }
      return table;
    }
    default: {
      Mover piano{{{cuboid({0, 0, 0}, {1.5, 0.3, 1.2}), cuboid({0, 0.3, -0.1}, {1.4, 0.3, 0.2})}},
                  0.6,
                  1.2};
      for (const double x : {-0.65, 0.65}) {
        piano.shape.pieces_C.push_back(cuboid({x, 0.4, -0.4}, {0.08, 0.08, 0.4}));
      }
      return piano;
    }
  }
}

motion::ConvexShape ring() {
  motion::ConvexShape shape;
  for (int i = 0; i < kRingParts; ++i) {
    Piece& piece = shape.pieces_C.emplace_back();
    for (const int k : {i, i + 1}) {
      const double angle_rad = 2.0 * std::numbers::pi * k / kRingParts;
      for (const double radius_m : {kRing_m - kRingHalf_m, kRing_m + kRingHalf_m}) {
        for (const double z_m : {-kRingHalf_m, kRingHalf_m}) {
          piece.emplace_back(radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), z_m);
        }
      }
    }
  }
  return shape;
}

/// Two rooms of 5 m by 6 m by 4 m, joined by a hole in the wall about the plane x = 0.
scene::Mesh two_rooms(double width_m, double height_m, double thickness_m, double sill_m) {
  constexpr double kLength_m = 5.0;
  constexpr double kHalf_m = 3.0;
  constexpr double kHeight_m = 4.0;
  constexpr double kPlate_m = 0.1;
  const double x = 0.5 * thickness_m;
  const double y = 0.5 * width_m;
  scene::Mesh mesh;
  add_cuboid(mesh, {-x, -kHalf_m, 0}, {x, -y, kHeight_m});
  add_cuboid(mesh, {-x, y, 0}, {x, kHalf_m, kHeight_m});
  add_cuboid(mesh, {-x, -y, sill_m + height_m}, {x, y, kHeight_m});
  if (sill_m > 0.0) add_cuboid(mesh, {-x, -y, 0}, {x, y, sill_m});
  add_cuboid(mesh, {-kLength_m, -kHalf_m, -kPlate_m}, {kLength_m, kHalf_m, 0});
  add_cuboid(mesh, {-kLength_m, -kHalf_m, kHeight_m}, {kLength_m, kHalf_m, kHeight_m + kPlate_m});
  for (const double side : {-1.0, 1.0}) {
    const Vec3 end(side * kLength_m, -kHalf_m, 0);
    add_cuboid(mesh, end.cwiseMin(end + Vec3(side * kPlate_m, 0, 0)),
               Vec3(end.x(), kHalf_m, kHeight_m).cwiseMax(end + Vec3(side * kPlate_m, 0, 0)));
    const Vec3 wall(-kLength_m, side * kHalf_m, 0);
    add_cuboid(mesh, wall.cwiseMin(wall + Vec3(0, side * kPlate_m, 0)),
               Vec3(kLength_m, wall.y(), kHeight_m).cwiseMax(wall + Vec3(0, side * kPlate_m, 0)));
  }
  return mesh;
}

/// A pole with many sides that fills the hole of the ring but for `spare`.
scene::Mesh pole(double spare) {
  const double radius_m =
      (kRing_m - kRingHalf_m) * std::cos(std::numbers::pi / kRingParts) / (1.0 + spare);
  const auto corner = [&](int i, double z_m) {
    const double angle_rad = 2.0 * std::numbers::pi * i / kPoleParts;
    return Vec3(radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), z_m);
  };
  scene::Mesh mesh;
  for (int i = 0; i < kPoleParts; ++i) {
    testing::add_parallelogram(mesh, corner(i, 0.0), corner(i + 1, 0.0) - corner(i, 0.0),
                               Vec3(0, 0, kPole_m));
    testing::add_triangle(mesh, corner(i, kPole_m), corner(i + 1, kPole_m), Vec3(0, 0, kPole_m));
  }
  add_cuboid(mesh, {-3, -3, -0.1}, {3, 3, 0});
  add_cuboid(mesh, {-3, -3, 4.5}, {3, 3, 4.6});
  return mesh;
}

NarrowCase robot_case(double spare, std::uint32_t seed) {
  constexpr double kAboveFloor_m = 0.02;
  constexpr double kBelowLintel_m = 0.08;
  const Vec3 size_m(0.6, 0.7, 1.6);
  testing::Random random(seed);
  NarrowCase narrow;
  narrow.scene =
      two_rooms((1.0 + spare) * size_m.y(), kAboveFloor_m + size_m.z() + kBelowLintel_m, 0.15, 0.0);
  narrow.request.body = motion::BoxShape{Vec3::Zero(), size_m};
  narrow.request.has_times = true;
  for (const double side : {-1.0, 1.0}) {
    const Vec3 place(side * random.uniform(1.5, 2.5), random.uniform(-0.8, 0.8),
                     kAboveFloor_m + 0.5 * size_m.z());
    const double time_s = side < 0.0 ? 0.0 : kDuration_s;
    narrow.request.keyframes.push_back({time_s, {place, Quat::Identity()}});
  }
  return narrow;
}

}  // namespace

NarrowCase narrow_case(std::size_t body, double spare, std::uint32_t seed) {
  if (kNarrowBodies[body] == "robot") return robot_case(spare, seed);
  testing::Random random(seed);
  const bool is_ring = kNarrowBodies[body] == "ring";
  // One case in four begins and ends as the hole is.
  const auto orientation = [&] { return seed % 4 == 3 ? Quat::Identity() : random.rotation(); };
  NarrowCase narrow;
  std::array<motion::Pose, 2> poses;
  if (is_ring) {
    narrow.scene = pole(spare);
    narrow.request.body = ring();
    poses = {motion::Pose{Vec3(0, 0, 1.0), Quat::Identity()},
             motion::Pose{Vec3(1.8, random.uniform(-1.0, 1.0), 1.2), orientation()}};
  } else {
    const Mover moving = mover(body);
    constexpr std::array<double, 4> kThickness_m = {0.1, 0.1, 0.3, 0.5};
    narrow.scene = two_rooms((1.0 + spare) * moving.width_m, (1.0 + spare) * moving.height_m,
                             kThickness_m[seed % 4], seed % 2 == 0 ? 0.0 : 1.0);
    narrow.request.body = moving.shape;
    for (std::size_t i = 0; i < 2; ++i) {
      const double side = i == 0 ? -1.0 : 1.0;
      const Vec3 place(side * 2.8, 0.0, 2.0);
      poses[i] = {place + Vec3(0.4, 1.0, 0.4).cwiseProduct(random.in_cube(1.0)), orientation()};
    }
  }
  narrow.request.has_times = true;
  narrow.request.keyframes = {{0.0, poses[0]}, {kDuration_s, poses[1]}};
  return narrow;
}

}  // namespace camway::bench
