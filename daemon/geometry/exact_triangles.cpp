// SPDX-License-Identifier: MIT
#include "daemon/geometry/exact_triangles.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "daemon/geometry/exact_integers.h"
#include "daemon/geometry/rounding.h"

namespace camway::geometry {
namespace {

using IntegerTriangle = std::array<IntegerVec, 3>;

Integer dot(const IntegerVec& a, const IntegerVec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

int lowest_exponent_of(const Triangle& a, const Triangle& b) {
  int lowest = std::numeric_limits<int>::max();
  for (const Triangle* triangle : {&a, &b}) {
    for (const Vec3& v : *triangle) {
      for (int k = 0; k < 3; ++k) {
        if (v[k] != 0.0) lowest = std::min(lowest, lowest_exponent(v[k]));
      }
    }
  }
  return lowest;
}

IntegerTriangle to_integers(const Triangle& triangle, int unit_exponent) {
  IntegerTriangle result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      result[i][k] = to_integer(triangle[i][static_cast<Eigen::Index>(k)], unit_exponent);
    }
  }
  return result;
}

class SeparationTest {
 public:
  SeparationTest(IntegerTriangle a, IntegerTriangle b) : a_(std::move(a)), b_(std::move(b)) {
    for (std::size_t i = 0; i < 3; ++i) {
      edges_a_[i] = difference(a_[(i + 1) % 3], a_[i]);
      edges_b_[i] = difference(b_[(i + 1) % 3], b_[i]);
    }
  }

  [[nodiscard]] bool separated() const {
    const std::vector<IntegerVec> normals = facet_normals();
    for (const IntegerVec& n : normals) {
      if (separates(n)) return true;
    }
    return normals.empty() ? separated_on_a_line() : separated_in_plane(normals.front());
  }

 private:
  [[nodiscard]] bool separates(const IntegerVec& n) const {
    const std::array<Integer, 3> a = {dot(n, a_[0]), dot(n, a_[1]), dot(n, a_[2])};
    const std::array<Integer, 3> b = {dot(n, b_[0]), dot(n, b_[1]), dot(n, b_[2])};
    const auto [min_a, max_a] = std::minmax_element(a.begin(), a.end());
    const auto [min_b, max_b] = std::minmax_element(b.begin(), b.end());
    return *min_b > *max_a || *min_a > *max_b;
  }

  /// Normals of the facets of the Minkowski difference, if it has any area.
  [[nodiscard]] std::vector<IntegerVec> facet_normals() const {
    std::vector<IntegerVec> normals = {cross(edges_a_[0], edges_a_[1]),
                                       cross(edges_b_[0], edges_b_[1])};
    for (const IntegerVec& e : edges_a_) {
      for (const IntegerVec& f : edges_b_) normals.push_back(cross(e, f));
    }
    std::erase_if(normals, is_zero);
    return normals;
  }

  /// Tests for separation if the Minkowski difference lies in a plane with this normal: complete in
  /// that case; in any case true only if separated.
  [[nodiscard]] bool separated_in_plane(const IntegerVec& normal) const {
    for (const auto* edges : {&edges_a_, &edges_b_}) {
      for (const IntegerVec& e : *edges) {
        if (separates(cross(normal, e))) return true;
      }
    }
    return false;
  }

  /// All edges are parallel (or zero): two segments on parallel lines, points included.
  [[nodiscard]] bool separated_on_a_line() const {
    const IntegerVec between = difference(a_[0], b_[0]);
    // On one line, this is along it.
    if (separates(between)) return true;
    for (const auto* edges : {&edges_a_, &edges_b_}) {
      for (const IntegerVec& e : *edges) {
        if (separates(cross(cross(e, between), e))) return true;
      }
    }
    return false;
  }

  IntegerTriangle a_;
  IntegerTriangle b_;
  std::array<IntegerVec, 3> edges_a_;
  std::array<IntegerVec, 3> edges_b_;
};

}  // namespace

bool triangles_touch_exactly(const Triangle& a, const Triangle& b) {
  const int unit_exponent = lowest_exponent_of(a, b);
  return !SeparationTest(to_integers(a, unit_exponent), to_integers(b, unit_exponent)).separated();
}

bool has_no_area_exactly(const Triangle& triangle) {
  const Vec3 e = triangle[1] - triangle[0];
  const Vec3 f = triangle[2] - triangle[0];
  const double e_max = e.lpNorm<Eigen::Infinity>();
  const double f_max = f.lpNorm<Eigen::Infinity>();
  // Each of the two products has the rounding of two differences and its own (3u), their difference
  // one more: (2·3u + 2u)·e_max·f_max to first order; 16 leaves room for the second.
  const double error = 16.0 * kUnitRoundoff * e_max * f_max + kSmallestNormal;
  if (e.cross(f).lpNorm<Eigen::Infinity>() > error) return false;
  const IntegerTriangle t = to_integers(triangle, lowest_exponent_of(triangle, triangle));
  return is_zero(cross(difference(t[1], t[0]), difference(t[2], t[0])));
}

}  // namespace camway::geometry
