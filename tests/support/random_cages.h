// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "tests/support/cage_checker.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::testing {

/// A random cage like those of hand-made and faulty models. Its bars have any section, cross each
/// other, and may be doubled, divided, missing, thin or displaced. Its bottom may be two plates
/// with a slot, or a floor with or without a hole.
struct RandomCage {
  scene::Mesh mesh;
  CageChecker::Parts parts;
  /// Whether all solids are parallel to the cage's frame, with exact coordinates in it.
  bool is_stepped = true;
  /// Quaternion that rotates the cage's frame into the world, of any length, so that it is exact.
  geometry::Quat turn = geometry::Quat::Identity();
  geometry::Box box;  ///< box through the axes of the bars, in the cage's frame
  std::array<std::vector<double>, 6> at_u,
      at_v;  ///< coordinates of the bars of each face, increasing
  double thickness_m = 0.0;

  [[nodiscard]] geometry::Vec3 in_world(const geometry::Vec3& v) const {
    return turn.normalized() * v;
  }
};

class CageMaker {
 public:
  explicit CageMaker(Random& random) : random_(random) {}

  RandomCage make() {
    cage_ = RandomCage{};
    cage_.is_stepped = chance(0.6);
    const Vec3 low = snapped(Vec3(within(-2, 2), within(-2, 2), within(-2, 2)));
    Vec3 size;
    for (int k = 0; k < 3; ++k) {
      bars_[static_cast<std::size_t>(k)] = number(2, 5);
      size[k] = bars_[static_cast<std::size_t>(k)] * kSteps * number(36, 60);
    }
    cage_.box = geometry::Box(low, low + size);
    cage_.thickness_m = 2 * kSteps * number(2, 5);
    // The bottom: bars (0, 1), plates (2) or a floor (3).
    below_ = number(0, 3);
    faults_ = chance(0.5) ? 0.0 : within(0.0, 0.06);
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool at_max : {false, true}) add_face(axis, at_max);
    }
    turn();
    return std::move(cage_);
  }

 private:
  /// Unit of coordinates: its multiples stay exact when rotated by an angle with cosine 3/5 or 4/5.
  static constexpr double kSteps = 5.0 / 1024;

  double within(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int number(int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random_);
  }
  bool chance(double share) { return within(0, 1) < share; }
  static double snapped(double x) { return kSteps * std::round(x / kSteps); }
  static Vec3 snapped(const Vec3& v) { return {snapped(v.x()), snapped(v.y()), snapped(v.z())}; }

  void add_solid(const Vec3& from, const Vec3& to) {
    std::vector<std::uint32_t> triangles;
    const auto first = static_cast<std::uint32_t>(cage_.mesh.triangles.size());
    add_cuboid(cage_.mesh, from, to);
    for (std::uint32_t t = first; t < first + 12; ++t) triangles.push_back(t);
    cage_.parts.solids.push_back(std::move(triangles));
  }

  /// Adds a prism with `sides` sides about the line between two points.
  void add_round(const Vec3& from, const Vec3& to, int sides) {
    const Vec3 along = (to - from).normalized();
    const Vec3 u = along.unitOrthogonal();
    const Vec3 v = along.cross(u);
    const auto first = static_cast<std::uint32_t>(cage_.mesh.vertices.size());
    const auto n = static_cast<std::uint32_t>(sides);
    std::vector<std::uint32_t> triangles;
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      triangles.push_back(static_cast<std::uint32_t>(cage_.mesh.triangles.size()));
      cage_.mesh.triangles.push_back({first + a, first + b, first + c});
    };
    const double start = within(0, 3);
    for (std::uint32_t i = 0; i < n; ++i) {
      const double angle = start + 2.0 * std::numbers::pi * i / n;
      const Vec3 out = 0.5 * cage_.thickness_m * (std::cos(angle) * u + std::sin(angle) * v);
      cage_.mesh.vertices.push_back(from + out);
      cage_.mesh.vertices.push_back(to + out);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t j = (i + 1) % n;
      add(2 * i, 2 * j, 2 * i + 1);
      add(2 * j, 2 * j + 1, 2 * i + 1);
      if (i > 1) {
        add(0, 2 * (i - 1), 2 * i);
        add(1, 2 * (i - 1) + 1, 2 * i + 1);
      }
    }
    cage_.parts.solids.push_back(std::move(triangles));
  }

  void add_bar(const Vec3& from, const Vec3& to, int across) {
    if (chance(faults_)) return;  // missing
    Vec3 a = from;
    Vec3 b = to;
    if (chance(faults_)) {  // displaced
      const double by = kSteps * number(-20, 20);
      a[across] += by;
      b[across] += by;
    }
    if (!cage_.is_stepped && chance(0.5)) {
      if (chance(0.5)) a[across] += within(-0.03, 0.03);
      add_round(a, b, number(3, 8));
      return;
    }
    const double half = chance(faults_) ? kSteps : cage_.thickness_m / 2;  // thin
    const Vec3 out = Vec3::Constant(half);
    if (chance(0.1)) {  // divided into two solids with a common side, which occurs twice
      int along = 0;
      (b - a).maxCoeff(&along);
      Vec3 middle = b;
      middle[along] = snapped(std::lerp(a[along], b[along], within(0.3, 0.7)));
      Vec3 end = middle + out;
      end[along] = middle[along];
      Vec3 begin = a - out;
      add_solid(begin, end);
      begin[along] = middle[along];
      add_solid(begin, b + out);
      return;
    }
    add_solid(a - out, b + out);
    if (chance(0.1)) add_solid(a - out, b + out);  // doubled
  }

  void add_face(int axis, bool at_max) {
    const geometry::Box& box = cage_.box;
    const double at = (at_max ? box.max() : box.min())[axis];
    const std::size_t name = 2 * static_cast<std::size_t>(axis) + (at_max ? 1 : 0);
    const bool is_below = axis == 2 && !at_max;
    for (const bool is_u : {true, false}) {
      const int across = (axis + (is_u ? 1 : 2)) % 3;
      const int along = (axis + (is_u ? 2 : 1)) % 3;
      const int count = bars_[static_cast<std::size_t>(across)];
      for (int i = 0; i <= count; ++i) {
        Vec3 from = box.min();
        Vec3 to = box.max();
        from[axis] = to[axis] = at;
        from[across] = to[across] = box.min()[across] + box.sizes()[across] / count * i;
        (is_u ? cage_.at_u : cage_.at_v)[name].push_back(from[across]);
        const bool is_border = i == 0 || i == count;
        // Plates or a floor replace these bars. Upright bars end on a floor.
        if (is_below && below_ >= 2 && !is_border) continue;
        if (below_ == 3 && along == 2) from[2] += cage_.thickness_m / 2;
        if (is_below && below_ == 3) continue;
        add_bar(from, to, across);
      }
    }
    if (is_below && below_ == 2) add_plates(at);
    if (is_below && below_ == 3) add_floor(at);
  }

  /// Adds two plates with a slot between them.
  void add_plates(double at) {
    const geometry::Box& box = cage_.box;
    const double middle = snapped(box.center().x());
    const double half_slot = kSteps * number(0, 25);
    const double half = cage_.thickness_m / 2;
    add_solid(Vec3(box.min().x(), box.min().y(), at - half),
              Vec3(middle - half_slot, box.max().y(), at + half));
    add_solid(Vec3(middle + half_slot, box.min().y(), at - half),
              Vec3(box.max().x(), box.max().y(), at + half));
    cage_.at_u[4] = {box.min().x(), middle - half_slot - half, middle + half_slot + half,
                     box.max().x()};
    cage_.at_v[4] = {box.min().y(), box.max().y()};
  }

  /// Adds a floor: four rectangles around a hole, or two without a hole.
  void add_floor(double at) {
    const geometry::Box& box = cage_.box;
    const Vec3 low = box.min() - Vec3::Constant(kSteps * 40);
    const Vec3 high = box.max() + Vec3::Constant(kSteps * 40);
    const Vec3 hole = snapped(Vec3(box.center()));
    const double half_u = chance(0.5) ? 0.0 : kSteps * number(1, 30);
    const double half_v = kSteps * number(1, 30);
    const auto rectangle = [&](double x0, double y0, double x1, double y1) {
      const auto first = static_cast<std::uint32_t>(cage_.mesh.triangles.size());
      add_triangle(cage_.mesh, Vec3(x0, y0, at), Vec3(x1, y0, at), Vec3(x1, y1, at));
      add_triangle(cage_.mesh, Vec3(x0, y0, at), Vec3(x1, y1, at), Vec3(x0, y1, at));
      cage_.parts.flats.insert(cage_.parts.flats.end(), {first, first + 1});
    };
    rectangle(low.x(), low.y(), hole.x() - half_u, high.y());
    rectangle(hole.x() + half_u, low.y(), high.x(), high.y());
    if (half_u > 0.0) {
      rectangle(hole.x() - half_u, low.y(), hole.x() + half_u, hole.y() - half_v);
      rectangle(hole.x() - half_u, hole.y() + half_v, hole.x() + half_u, high.y());
    }
    const double half = cage_.thickness_m / 2;
    cage_.at_u[4] = {box.min().x(), hole.x() - half_u - half, hole.x() + half_u + half,
                     box.max().x()};
    cage_.at_v[4] = {box.min().y(), hole.y() - half_v - half, hole.y() + half_v + half,
                     box.max().y()};
  }

  /// Rotates the cage about one axis, by an angle with exact coordinates or by any angle; or not.
  void turn() {
    const int axis = number(0, 2);
    const int kind = number(0, 3);
    if (kind == 0) return;
    const double tangent_of_half = kind == 1 ? 1.0 / 2 : (kind == 2 ? 1.0 / 3 : within(0.05, 0.4));
    if (kind == 3) cage_.is_stepped = false;
    cage_.turn = geometry::Quat(1.0, 0.0, 0.0, 0.0);
    cage_.turn.vec()[axis] = tangent_of_half;
    if (kind == 1) cage_.turn = geometry::Quat(2.0, axis == 0, axis == 1, axis == 2);
    if (kind == 2) cage_.turn = geometry::Quat(3.0, axis == 0, axis == 1, axis == 2);
    const double w = cage_.turn.w();
    const double s = cage_.turn.vec()[axis];
    for (Vec3& vertex : cage_.mesh.vertices) {
      const double a = vertex[(axis + 1) % 3];
      const double b = vertex[(axis + 2) % 3];
      // Products of small integers and multiples of a power of 2; only the division can round.
      vertex[(axis + 1) % 3] = ((w * w - s * s) * a - 2 * w * s * b) / (w * w + s * s);
      vertex[(axis + 2) % 3] = ((w * w - s * s) * b + 2 * w * s * a) / (w * w + s * s);
    }
  }

  Random& random_;
  RandomCage cage_;
  std::array<int, 3> bars_{};
  int below_ = 0;
  double faults_ = 0.0;
};

}  // namespace camway::testing
