// SPDX-License-Identifier: MIT
#pragma once

#include <boost/multiprecision/cpp_int.hpp>

#include "daemon/geometry/types.h"

/// Slow and obviously right: the definitions, in rational arithmetic. Shares nothing with the
/// kernels.
namespace camway::geometry::oracle {

using Rational = boost::multiprecision::cpp_rational;

/// Squared distance of the closed triangles, degenerate ones included; 0 exactly if they touch.
Rational squared_distance(const Triangle& a, const Triangle& b);

/// Whether the closed triangle and the closed box have a point in common.
bool touches_box(const Triangle& triangle, const Box& box);

/// The same as a double; relative error below 2^-51.
double distance_m(const Triangle& a, const Triangle& b);

}  // namespace camway::geometry::oracle
