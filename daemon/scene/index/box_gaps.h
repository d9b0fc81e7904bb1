// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "daemon/geometry/oriented_box.h"
#include "daemon/scene/index/index_node.h"

namespace camway::scene {

/// A box, laid out to be loaded four numbers at a time; the fourth numbers are 0.
struct BoxSides {
  BoxSides() = default;
  explicit BoxSides(const geometry::Box& box)
      : low_m{box.min()[0], box.min()[1], box.min()[2], 0.0},
        high_m{box.max()[0], box.max()[1], box.max()[2], 0.0} {}

  std::array<double, 4> low_m{};
  std::array<double, 4> high_m{};
};

/// Lower bounds of the squared distances between one box and eight others.
struct BoxGaps {
  std::array<float, kNodeWidth> squared;  ///< bounds, in units of `square_m2`
  double square_m2;                       ///< the square of the frame's largest step
  unsigned near;  ///< bit i is set unless box i is proved to be beyond the reach
};

/// A lower bound may exceed the true square by this relative amount, through rounding. The
/// difference of two floats, its square and the sum of three squares are rounded, 2^-24 each: (1 +
/// 2^-24)^2·(1 + 2^-24)^3 at most.
inline constexpr double kBoxGapRelativeError = 8.0 * 0x1p-24;

/// An oriented box, laid out for `box_gaps`. Entry 3 of each array is 0.
struct ObliqueSides {
  ObliqueSides() = default;
  explicit ObliqueSides(const geometry::OrientedBox& box);

  std::array<double, 4> origin_m{};
  std::array<std::array<double, 4>, 3> axis{};  ///< components of the axes, [coordinate][axis]
  std::array<double, 4> low_m{};                ///< extents along the axes, from the origin
  std::array<double, 4> high_m{};
};

/// A box in the steps of a frame: what the bounds of all boxes of the frame have in common. The
/// sides are rounded down, upper ones negated. Entry 3 of each array has no meaning.
struct FramedBox {
  int largest = 0;  ///< exponent of the frame's largest step
  bool is_oblique = false;
  std::array<float, 4> share_of_largest;  ///< size of a step, relative to the largest one
  std::array<float, 4> from;
  std::array<float, 4> minus_to;
  // Along the axes of the body:
  std::array<std::array<float, 3>, 3> weights;  ///< of the frame's steps, for each axis
  std::array<float, 4> above_from;              ///< distances of the frame's origin from the sides
  std::array<float, 4> below_from;
};

/// Converts `box` to the steps of `frame`, and so `body` within it, if that is not null.
void put_in_frame(const ByteFrame& frame, const BoxSides& box, const ObliqueSides* body,
                  FramedBox& out);

/// Computes the bounds between `box` and the eight `boxes` of its frame, and which boxes are near:
/// those whose bound does not exceed `squared_reach_m2` by more than its rounding. The bound of
/// boxes that touch is 0; a NaN never makes a bound above 0.
///
/// A body within the box raises the bounds to those along its own axes, along which boxes are often
/// farther away than along those of the world. It is looked at only if a box is near. The bounds
/// allow for rounding in units of the steps. They do not allow for the rounding of coordinates far
/// from each other. The caller must enlarge the reach by that error, which is that of
/// `OrientedBox::squared_distance_bound_m2`.
///
/// Bit-identical on every processor: the same operations in the same order, eight at a time with
/// AVX2 and four at a time without.
void box_gaps(const FramedBox& box, const ByteBoxes& boxes, double squared_reach_m2, BoxGaps& out);

}  // namespace camway::scene
