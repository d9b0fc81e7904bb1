// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include "tests/motion/random_motion.h"

/// Point sets that are hard for convex hulls, and exact arithmetic to check the hulls.
namespace camway::geometry::test {

struct PointSet {
  std::string what;
  std::vector<Vec3> points;
};

/// Returns sets with volume: in general position; on small grids with many coplanar, collinear and
/// equal points; spheres; needles and plates of almost no thickness; far from the origin; tiny.
std::vector<PointSet> solid_point_sets(testing::Random& random);

/// Returns sets exactly in one plane that is not parallel to an axis, with grid points and
/// repetitions.
std::vector<PointSet> flat_point_sets(testing::Random& random);

using Rational = boost::multiprecision::cpp_rational;
struct RationalVec : std::array<Rational, 3> {};

RationalVec exact(const Vec3& v);
RationalVec operator-(const RationalVec& a, const RationalVec& b);
RationalVec cross(const RationalVec& a, const RationalVec& b);
Rational dot(const RationalVec& a, const RationalVec& b);

/// Returns six times the volume of a tetrahedron, positive if d is on the side to which
/// (b - a) × (c - a) points.
Rational exact_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace camway::geometry::test
