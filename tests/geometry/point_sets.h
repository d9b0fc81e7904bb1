// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include "tests/motion/random_motion.h"

/// Sets of points that are hard for hulls, and arithmetic without rounding to judge them by.
namespace camway::geometry::test {

struct PointSet {
  std::string what;
  std::vector<Vec3> points;
};

/// Sets with volume: in general position, on small grids (coplanar, collinear and equal points
/// everywhere), spheres, needles and plates of nearly no thickness, far from the origin, tiny.
std::vector<PointSet> solid_point_sets(motion::test::Random& random);

/// Sets exactly in one plane that is parallel to no axis, with grid points and repetitions.
std::vector<PointSet> flat_point_sets(motion::test::Random& random);

using Rational = boost::multiprecision::cpp_rational;
struct RationalVec : std::array<Rational, 3> {};

RationalVec exact(const Vec3& v);
RationalVec operator-(const RationalVec& a, const RationalVec& b);
RationalVec cross(const RationalVec& a, const RationalVec& b);
Rational dot(const RationalVec& a, const RationalVec& b);

/// Six times the volume of the tetrahedron, positive if d is on the side to which
/// (b - a) × (c - a) points.
Rational exact_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace camway::geometry::test
