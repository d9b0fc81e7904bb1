// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "daemon/geometry/oriented_box.h"
#include "daemon/scene/index/index_node.h"

namespace camway::scene {

/// A box, laid out to be loaded four numbers at a time; the fourth are 0.
struct BoxSides {
  BoxSides() = default;
  explicit BoxSides(const geometry::Box& box)
      : low_m{box.min()[0], box.min()[1], box.min()[2], 0.0},
        high_m{box.max()[0], box.max()[1], box.max()[2], 0.0} {}

  std::array<double, 4> low_m{};
  std::array<double, 4> high_m{};
};

/// Lower bounds of the squared distances between a box and eight.
struct BoxGaps {
  std::array<float, kNodeWidth> squared;  ///< in units of `square_m2`
  double square_m2;                       ///< the square of the frame's largest step
  unsigned near;                          ///< bit i: box i is not proved to be beyond the reach
};

/// How far above its true square a bound may be, relatively: the difference of two floats, its
/// square and the sum of three squares are rounded, 2^-24 each: (1 + 2^-24)^2·(1 + 2^-24)^3 at
/// most.
inline constexpr double kBoxGapRelativeError = 8.0 * 0x1p-24;

/// Bounds for `boxes` in `frame`, against `box`, and which of them are not above
/// `squared_reach_m2` by more than their rounding. A bound is 0 for boxes that touch; a NaN never
/// makes a bound above 0.
///
/// The same operations in the same order whatever the processor: with AVX2 eight at a time, else
/// four.
void box_gaps(const ByteFrame& frame, const ByteBoxes& boxes, const BoxSides& box,
              double squared_reach_m2, BoxGaps& out);

/// An oriented box, laid out for `oblique_gaps`. Numbers 3 of each array are 0.
struct ObliqueSides {
  ObliqueSides() = default;
  explicit ObliqueSides(const geometry::OrientedBox& box);

  std::array<double, 4> origin_m{};
  std::array<std::array<double, 4>, 3> axis{};  ///< [coordinate][axis]
  std::array<double, 4> low_m{};                ///< along the axes, from the origin
  std::array<double, 4> high_m{};
};

/// Improves `gaps`, which `box_gaps` has made for the same boxes and a box around `body`: along the
/// axes of the body they are often further away than along those of the world. Rounding in units of
/// the steps is taken care of, as there; that of coordinates far from each other adds up to the
/// error of `OrientedBox::squared_distance_bound_m2`, which the reach must allow for.
void oblique_gaps(const ByteFrame& frame, const ByteBoxes& boxes, const ObliqueSides& body,
                  double squared_reach_m2, BoxGaps& gaps);

}  // namespace camway::scene
