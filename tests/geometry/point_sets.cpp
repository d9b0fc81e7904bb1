// SPDX-License-Identifier: MIT
#include "tests/geometry/point_sets.h"

namespace camway::geometry::test {
namespace {

Vec3 on_grid(testing::Random& random, int most) {
  return {static_cast<double>(random.integer(0, most)),
          static_cast<double>(random.integer(0, most)),
          static_cast<double>(random.integer(0, most))};
}

template <class Make>
std::vector<Vec3> many(int count, const Make& make) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.push_back(make());
  return points;
}

}  // namespace

std::vector<PointSet> solid_point_sets(testing::Random& random) {
  std::vector<PointSet> sets;
  for (int round = 0; round < 3; ++round) {
    const int count = random.integer(5, 120);
    sets.push_back({"general", many(count, [&] { return random.normal_vector(1.0); })});
    sets.push_back({"grid 0..2", many(count + 30, [&] { return on_grid(random, 2); })});
    sets.push_back({"grid 0..6", many(count + 30, [&] { return on_grid(random, 6); })});
    sets.push_back({"sphere", many(count, [&] { return random.normal_vector(1.0).normalized(); })});
    const Quat turn = random.rotation();
    const auto squeezed = [&](const Vec3& by) {
      return many(count, [&] { return turn * random.normal_vector(1.0).cwiseProduct(by); });
    };
    sets.push_back({"needle", squeezed({1.0, 1e-12, 1e-12})});
    sets.push_back({"plate", squeezed({1.0, 1.0, 1e-14})});
    sets.push_back({"tilted grid", many(count + 30, [&] { return turn * on_grid(random, 3); })});
    sets.push_back({"far away", many(count, [&] {
                      return Vec3(Vec3(1e6, -1e6, 1e6) + random.normal_vector(1e-3));
                    })});
    sets.push_back({"tiny", many(count, [&] { return random.normal_vector(1e-170); })});
    sets.push_back({"wide range", many(count, [&] {
                      return Vec3(random.log_uniform(1e-300, 1e9) *
                                  random.normal_vector(0.1).normalized());
                    })});
  }
  return sets;
}

std::vector<PointSet> flat_point_sets(testing::Random& random) {
  std::vector<PointSet> sets;
  for (int round = 0; round < 10; ++round) {
    // x, y and a sum of multiples of them are exact for small integers.
    const double a = random.integer(-3, 3);
    const double b = random.integer(1, 3);
    sets.push_back({"plane", many(random.integer(8, 60), [&] {
                      const Vec3 p = on_grid(random, 5);
                      return Vec3(p.x(), p.y(), a * p.x() + b * p.y());
                    })});
    sets.push_back({"plane of y and z", many(random.integer(8, 60), [&] {
                      const Vec3 p = on_grid(random, 4);
                      return Vec3(2.5, p.y(), p.z());
                    })});
  }
  return sets;
}

RationalVec exact(const Vec3& v) { return {{Rational(v.x()), Rational(v.y()), Rational(v.z())}}; }

RationalVec operator-(const RationalVec& a, const RationalVec& b) {
  return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
}

RationalVec cross(const RationalVec& a, const RationalVec& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

Rational dot(const RationalVec& a, const RationalVec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Rational exact_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const RationalVec from = exact(a);
  return dot(cross(exact(b) - from, exact(c) - from), exact(d) - from);
}

}  // namespace camway::geometry::test
