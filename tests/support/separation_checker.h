// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include "daemon/scene/mesh/mesh.h"
#include "tests/support/random.h"

/// Checks whether a surface separates two points, from the mesh's triangles, the indices and the
/// points alone. Shares no code with the search for such surfaces: rays have random directions
/// instead of an axis, arithmetic is on integers instead of filters, the predicates differ, and a
/// ray that meets an edge or a vertex is discarded instead of perturbed.
namespace camway::testing {

class SeparationChecker {
 public:
  using Integer = boost::multiprecision::cpp_int;
  using Point = std::array<Integer, 3>;

  SeparationChecker(const scene::Mesh& mesh, std::span<const std::uint32_t> triangles)
      : triangles_(triangles.begin(), triangles.end()) {
    for (const std::uint32_t t : triangles_) {
      if (t >= mesh.triangles.size()) {
        wrong_ = "no triangle " + std::to_string(t);
        return;
      }
      const geometry::Triangle corners = mesh.triangle(t);
      corners_.push_back({exact(corners[0]), exact(corners[1]), exact(corners[2])});
    }
    for (std::size_t i = 1; i < triangles_.size(); ++i) {
      if (triangles_[i] <= triangles_[i - 1]) wrong_ = "indices do not increase";
    }
    count_edges();
  }

  /// Returns the fault; empty if the surface is closed, `inside` is inside and `outside` outside.
  [[nodiscard]] std::string check(const geometry::Vec3& inside,
                                  const geometry::Vec3& outside) const {
    if (!wrong_.empty()) return wrong_;
    const std::optional<bool> first = odd_from(inside);
    const std::optional<bool> second = odd_from(outside);
    if (!first || !second) return "a point is on the surface";
    if (!*first) return "the point inside is not inside";
    return *second ? "the point outside is not outside" : "";
  }

  /// Returns whether a ray from `p` crosses the surface an odd number of times. Returns nothing if
  /// `p` is on a triangle, or if every ray that was tried meets an edge, as all do if `p` is on
  /// one.
  [[nodiscard]] std::optional<bool> odd_from(const geometry::Vec3& p) const {
    Random random(7);
    for (int attempt = 0; attempt < 20; ++attempt) {
      geometry::Vec3 direction;
      for (double& x : direction) {
        x = std::uniform_real_distribution<double>(-1.0, 1.0)(random);
      }
      bool degenerate = false;
      const bool odd = crossings_are_odd(exact(p), exact(direction), degenerate);
      if (!degenerate) return odd;
    }
    return std::nullopt;
  }

 private:
  /// Returns `x` in units of 2^-140. Throws std::range_error unless `x` is a multiple of that.
  static Integer exact(double x) {
    constexpr int kUnitExponent = -140;
    constexpr int kDigits = 53;
    int exponent = 0;
    const double fraction = std::frexp(x, &exponent);
    const Integer mantissa(static_cast<std::int64_t>(std::ldexp(fraction, kDigits)));
    const int shift = exponent - kDigits - kUnitExponent;
    if (shift >= 0) return mantissa << shift;
    Integer result = mantissa / (Integer(1) << -shift);
    if ((result << -shift) != mantissa) throw std::range_error("a coordinate is too fine");
    return result;
  }
  static Point exact(const geometry::Vec3& v) { return {exact(v.x()), exact(v.y()), exact(v.z())}; }

  static Point minus(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }
  static Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  static Integer dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  void count_edges() {
    std::map<std::array<Point, 2>, int> uses;
    for (const std::array<Point, 3>& t : corners_) {
      for (std::size_t k = 0; k < 3; ++k) {
        std::array<Point, 2> edge = {t[k], t[(k + 1) % 3]};
        if (edge[1] < edge[0]) std::swap(edge[0], edge[1]);
        ++uses[edge];
      }
    }
    for (const auto& [edge, count] : uses) {
      if (count % 2 != 0 && edge[0] != edge[1]) wrong_ = "an edge has an odd number of triangles";
    }
  }

  /// Returns whether the ray from `p` along `direction` crosses the surface an odd number of times,
  /// by the signs of the Plücker products of the ray with the edges.
  [[nodiscard]] bool crossings_are_odd(const Point& p, const Point& direction,
                                       bool& degenerate) const {
    bool odd = false;
    for (const std::array<Point, 3>& t : corners_) {
      const std::array<Point, 3> r = {minus(t[0], p), minus(t[1], p), minus(t[2], p)};
      const std::array<Point, 3> moment = {cross(direction, r[0]), cross(direction, r[1]),
                                           cross(direction, r[2])};
      const std::array<int, 3> sign = {dot(moment[0], r[1]).sign(), dot(moment[1], r[2]).sign(),
                                       dot(moment[2], r[0]).sign()};
      if (sign[0] * sign[1] < 0 || sign[1] * sign[2] < 0 || sign[0] * sign[2] < 0) continue;
      if (sign[0] * sign[1] * sign[2] == 0) {
        degenerate = true;
        return false;
      }
      const int side = dot(cross(r[0], r[1]), r[2]).sign();
      if (side == 0) {
        degenerate = true;  // `p` itself is on the triangle
        return false;
      }
      if (side == sign[0]) odd = !odd;
    }
    return odd;
  }

  std::vector<std::uint32_t> triangles_;
  std::vector<std::array<Point, 3>> corners_;
  std::string wrong_;
};

}  // namespace camway::testing
