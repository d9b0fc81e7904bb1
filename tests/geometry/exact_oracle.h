// SPDX-License-Identifier: MIT
#pragma once

#include <boost/multiprecision/cpp_int.hpp>

#include "daemon/geometry/types.h"

/// Slow and simple oracles: the definitions in rational arithmetic. Share no code with the kernels.
namespace camway::geometry::oracle {

using Rational = boost::multiprecision::cpp_rational;

/// Returns the squared distance of closed triangles, which may be degenerate; 0 exactly if they
/// touch.
Rational squared_distance(const Triangle& a, const Triangle& b);

/// Returns whether the closed triangle and the closed box share a point.
bool touches_box(const Triangle& triangle, const Box& box);

/// Returns the distance as a double, with a relative error below 2^-51.
double distance_m(const Triangle& a, const Triangle& b);

}  // namespace camway::geometry::oracle
