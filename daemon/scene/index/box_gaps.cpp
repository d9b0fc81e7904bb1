// SPDX-License-Identifier: MIT
#include "daemon/scene/index/box_gaps.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "daemon/base/cpu_dispatch.h"

#ifdef CAMWAY_WITH_AVX2
#include <immintrin.h>
#endif

namespace camway::scene {
namespace {

// Vector types of GCC and Clang: written once, compiled to what the processor has.
using Floats = float __attribute__((vector_size(32)));
using Ints = std::int32_t __attribute__((vector_size(32)));
using HalfFloats = float __attribute__((vector_size(16)));
using Doubles = double __attribute__((vector_size(32)));
using Longs = std::int64_t __attribute__((vector_size(32)));
using Shorts = std::uint16_t __attribute__((vector_size(16)));
using TwiceShorts = std::uint16_t __attribute__((vector_size(32)));
using TwiceBytes = std::uint8_t __attribute__((vector_size(16)));

/// Coordinates beyond this many steps are clamped to it. Bounds only become smaller, nothing
/// overflows, and boxes this far away are beyond any reach.
constexpr double kFarthestStep = 0x1p60;

/// A coordinate in steps has a rounding of 2^-53 (the difference) and 2^-24 (to float), relative to
/// itself; moving it outwards rounds twice more. 2^-21 is more than all of these; 2^-20 of a step
/// covers `kByteBoxError`.
constexpr float kRelativeMove = 0x1p-21F;
constexpr float kLeastMove = 0x1p-20F;

/// Along an oblique axis a box has three products of at most 255 steps each. A weight is rounded
/// once, a product once, and each of the sums once more: 255·3·5 roundings of 2^-24, less than
/// 2^-12. Twice that covers a share of the 2^-24 of the other summand.
constexpr float kObliqueMove = 0x1p-11F;

/// The bound's own error, and twice the rounding of the limit to float.
constexpr double kLimitMove = kBoxGapRelativeError + 0x1p-22;
/// More than any bound, which has at most `kFarthestStep` in each of three axes.
constexpr double kLargestLimit = 0x1p126;

// By reference: by value the calling convention would depend on the processor.
[[gnu::always_inline]] inline void load(const std::array<double, 4>& numbers, Doubles& out) {
  std::memcpy(&out, numbers.data(), sizeof out);
}

/// `steps` as floats that are surely not above them.
[[gnu::always_inline]] inline void move_down(Doubles& steps, float least, HalfFloats& out) {
  const Doubles farthest = {kFarthestStep, kFarthestStep, kFarthestStep, kFarthestStep};
  steps = steps > farthest ? farthest : steps;
  steps = steps < -farthest ? -farthest : steps;
  const HalfFloats x = __builtin_convertvector(steps, HalfFloats);
  const HalfFloats size = x < 0.0F ? -x : x;
  out = x - (size * kRelativeMove + least);
}

/// The sides of eight boxes in steps, axis by axis.
struct Sides {
  Floats low[3];
  Floats high[3];
};

[[gnu::always_inline]] inline void to_floats(const std::uint8_t* steps, Floats& first,
                                             Floats& second) {
  TwiceBytes bytes;
  std::memcpy(&bytes, steps, sizeof bytes);
  // Sixteen at a time and in single steps: otherwise GCC 12 converts bytes in halves or one by one.
  const TwiceShorts shorts = __builtin_convertvector(bytes, TwiceShorts);
  const Shorts low = __builtin_shufflevector(shorts, shorts, 0, 1, 2, 3, 4, 5, 6, 7);
  const Shorts high = __builtin_shufflevector(shorts, shorts, 8, 9, 10, 11, 12, 13, 14, 15);
  first = __builtin_convertvector(__builtin_convertvector(low, Ints), Floats);
  second = __builtin_convertvector(__builtin_convertvector(high, Ints), Floats);
}

/// The two steps that AVX2 has instructions for, on any processor.
struct Portable {
  [[gnu::always_inline]] static void sides_of(const ByteBoxes& boxes, Sides& out) {
    static_assert(sizeof(ByteBoxes) == 6 * kNodeWidth && kNodeWidth == 8);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&boxes);
    to_floats(bytes, out.low[0], out.low[1]);
    to_floats(bytes + 16, out.low[2], out.high[0]);
    to_floats(bytes + 32, out.high[1], out.high[2]);
  }

  /// Sets bit i of the result if lane i is not above `limit`.
  [[gnu::always_inline]] static unsigned not_above(const Floats& lanes, float limit) {
    constexpr Ints kBits = {1, 2, 4, 8, 16, 32, 64, 128};
    const Ints above = (lanes > limit) & kBits;
    Longs halves;
    std::memcpy(&halves, &above, sizeof halves);
    const auto joined = static_cast<std::uint64_t>(halves[0] | halves[1] | halves[2] | halves[3]);
    return ~static_cast<unsigned>(joined | joined >> 32U) & 0xFFU;
  }
};

#ifdef CAMWAY_WITH_AVX2
/// The same in a third of the instructions, for which GCC 12 finds none.
struct Avx2 {
  [[gnu::always_inline]] CAMWAY_WITH_AVX2 static void sides_of(const ByteBoxes& boxes, Sides& out) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      to_floats(boxes.low[axis], out.low[axis]);
      to_floats(boxes.high[axis], out.high[axis]);
    }
  }

  [[gnu::always_inline]] CAMWAY_WITH_AVX2 static unsigned not_above(const Floats& lanes,
                                                                    float limit) {
    const __m256 above = _mm256_cmp_ps(lanes, _mm256_set1_ps(limit), _CMP_GT_OQ);
    return ~static_cast<unsigned>(_mm256_movemask_ps(above)) & 0xFFU;
  }

 private:
  [[gnu::always_inline]] CAMWAY_WITH_AVX2 static void to_floats(
      const std::array<std::uint8_t, kNodeWidth>& steps, Floats& out) {
    std::int64_t bytes;
    std::memcpy(&bytes, steps.data(), sizeof bytes);
    out = _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_cvtsi64_si128(bytes)));
  }
};
#endif

/// Squared gaps on one axis, in units of which a step is `weight`; a product with a power of two is
/// exact. The sides of the box are rounded down: `from` is the lower one, `minus_to` the upper one,
/// negated.
[[gnu::always_inline]] inline void squared_gaps(const Sides& boxes, std::size_t axis, float from,
                                                float minus_to, float weight, Floats& out) {
  const Floats below = boxes.low[axis] + minus_to;
  const Floats above = from - boxes.high[axis];
  Floats gap = below > above ? below : above;
  gap = gap > 0.0F ? gap : Floats{};
  gap *= weight;
  out = gap * gap;
}

/// `weight` times the least, and times the greatest, coordinate of each box on this axis.
[[gnu::always_inline]] inline void extremes(const Sides& boxes, std::size_t axis, float weight,
                                            Floats& least, Floats& greatest) {
  const Floats& begin = boxes.low[axis];
  const Floats& end = boxes.high[axis];
  least = (weight > 0.0F ? begin : end) * weight;
  greatest = (weight > 0.0F ? end : begin) * weight;
}

/// Squared gaps along one axis of the body, which has these weights along the axes of the boxes.
/// `above_from` and `below_from` are the distances of the frame's origin from the body's two sides,
/// rounded down.
[[gnu::always_inline]] inline void squared_oblique_gaps(const Sides& boxes,
                                                        const std::array<float, 3>& weights,
                                                        float above_from, float below_from,
                                                        Floats& out) {
  Floats least, greatest, more, most;
  extremes(boxes, 0, weights[0], least, greatest);
  extremes(boxes, 1, weights[1], more, most);
  least += more;
  greatest += most;
  extremes(boxes, 2, weights[2], more, most);
  least += more;
  greatest += most;
  const Floats above = least + above_from;
  const Floats below = below_from - greatest;
  Floats gap = above > below ? above : below;
  gap = gap > 0.0F ? gap : Floats{};
  out = gap * gap;
}

/// The bounds along the axes of the world.
[[gnu::always_inline]] inline void bounds_along_world(const FramedBox& box, const Sides& boxes,
                                                      Floats& sum) {
  Floats on_axis;
  squared_gaps(boxes, 0, box.from[0], box.minus_to[0], box.share_of_largest[0], sum);
  squared_gaps(boxes, 1, box.from[1], box.minus_to[1], box.share_of_largest[1], on_axis);
  sum += on_axis;
  squared_gaps(boxes, 2, box.from[2], box.minus_to[2], box.share_of_largest[2], on_axis);
  sum += on_axis;
}

/// Raises the bounds to those along the axes of the body.
[[gnu::always_inline]] inline void raise_to_bounds_along_body(const FramedBox& box,
                                                              const Sides& boxes, Floats& squared) {
  Floats sum, on_axis;
  squared_oblique_gaps(boxes, box.weights[0], box.above_from[0], box.below_from[0], sum);
  for (std::size_t k = 1; k < 3; ++k) {
    squared_oblique_gaps(boxes, box.weights[k], box.above_from[k], box.below_from[k], on_axis);
    sum += on_axis;
  }
  squared = sum > squared ? sum : squared;
}

/// Bounds up to this one are near, in units of the frame's largest step.
[[gnu::always_inline]] inline float limit_of(const FramedBox& box, double squared_reach_m2) {
  const double limit = squared_reach_m2 * power_of_two(-2 * box.largest) * (1.0 + kLimitMove);
  return static_cast<float>(std::min(limit, kLargestLimit)) + std::numeric_limits<float>::min();
}

[[gnu::always_inline]] inline void store(const HalfFloats& numbers, std::array<float, 4>& out) {
  std::memcpy(out.data(), &numbers, sizeof numbers);
}

/// The sides along the axes of the body.
[[gnu::always_inline]] inline void put_body_in(const ByteFrame& frame,
                                               const HalfFloats& share_of_largest,
                                               const ObliqueSides& body, FramedBox& out) {
  Doubles axis_x, axis_y, axis_z, low, high;
  load(body.axis[0], axis_x);
  load(body.axis[1], axis_y);
  load(body.axis[2], axis_z);
  load(body.low_m, low);
  load(body.high_m, high);
  // Origin of the frame along the axes of the body.
  const Doubles offset = axis_x * (frame.origin[0] - body.origin_m[0]) +
                         axis_y * (frame.origin[1] - body.origin_m[1]) +
                         axis_z * (frame.origin[2] - body.origin_m[2]);
  const double per_m = power_of_two(-out.largest);
  Doubles down = (offset - high) * per_m;
  Doubles up = (low - offset) * per_m;
  HalfFloats above_from, below_from;
  move_down(down, kObliqueMove, above_from);
  move_down(up, kObliqueMove, below_from);
  store(above_from, out.above_from);
  store(below_from, out.below_from);
  const HalfFloats x = __builtin_convertvector(axis_x, HalfFloats) * share_of_largest[0];
  const HalfFloats y = __builtin_convertvector(axis_y, HalfFloats) * share_of_largest[1];
  const HalfFloats z = __builtin_convertvector(axis_z, HalfFloats) * share_of_largest[2];
  for (std::size_t k = 0; k < 3; ++k) out.weights[k] = {x[k], y[k], z[k]};
}

}  // namespace

ObliqueSides::ObliqueSides(const geometry::OrientedBox& box) {
  for (int k = 0; k < 3; ++k) {
    const auto at = static_cast<std::size_t>(k);
    origin_m[at] = box.origin()[k];
    low_m[at] = box.low_m(k);
    high_m[at] = box.high_m(k);
    const geometry::Vec3 axis_W = box.axis(k);
    for (int c = 0; c < 3; ++c) axis[static_cast<std::size_t>(c)][at] = axis_W[c];
  }
}

CAMWAY_FOR_EVERY_PROCESSOR
void put_in_frame(const ByteFrame& frame, const BoxSides& box, const ObliqueSides* body,
                  FramedBox& out) {
  const Longs exponent = {frame.exponent[0], frame.exponent[1], frame.exponent[2], 0};
  out.largest = std::max({frame.exponent[0], frame.exponent[1], frame.exponent[2]});
  const Doubles steps_per_m = reinterpret_cast<Doubles>((1023 - exponent) << 52);
  const Doubles shares = reinterpret_cast<Doubles>((1023 - out.largest + exponent) << 52);
  const HalfFloats share_of_largest = __builtin_convertvector(shares, HalfFloats);
  store(share_of_largest, out.share_of_largest);
  const Doubles origin = {frame.origin[0], frame.origin[1], frame.origin[2], 0.0};
  Doubles low, high;
  load(box.low_m, low);
  load(box.high_m, high);
  // Both sides are rounded down, the upper one negated.
  Doubles down = (low - origin) * steps_per_m;
  Doubles up = (origin - high) * steps_per_m;
  HalfFloats from, minus_to;
  move_down(down, kLeastMove, from);
  move_down(up, kLeastMove, minus_to);
  store(from, out.from);
  store(minus_to, out.minus_to);
  out.is_oblique = body != nullptr;
  if (body != nullptr) put_body_in(frame, share_of_largest, *body, out);
}

namespace {

[[gnu::always_inline]] inline void store(const Floats& squared, const FramedBox& box,
                                         BoxGaps& out) {
  std::memcpy(out.squared.data(), &squared, sizeof squared);
  out.square_m2 = power_of_two(2 * box.largest);
}

// The two versions differ in their processor alone. GCC inlines no function with instructions of
// AVX2 into one that is compiled for all processors, so they cannot share this frame.
#ifdef CAMWAY_WITH_AVX2
CAMWAY_WITH_AVX2 void gaps_on(const FramedBox& box, const ByteBoxes& boxes, double squared_reach_m2,
                              BoxGaps& out) {
  Sides sides;
  Floats squared;
  Avx2::sides_of(boxes, sides);
  bounds_along_world(box, sides, squared);
  const float limit = limit_of(box, squared_reach_m2);
  out.near = Avx2::not_above(squared, limit);
  if (box.is_oblique && out.near != 0) {
    raise_to_bounds_along_body(box, sides, squared);
    out.near = Avx2::not_above(squared, limit);
  }
  store(squared, box, out);
}
#endif

CAMWAY_WITHOUT_AVX2 void gaps_on(const FramedBox& box, const ByteBoxes& boxes,
                                 double squared_reach_m2, BoxGaps& out) {
  Sides sides;
  Floats squared;
  Portable::sides_of(boxes, sides);
  bounds_along_world(box, sides, squared);
  const float limit = limit_of(box, squared_reach_m2);
  out.near = Portable::not_above(squared, limit);
  if (box.is_oblique && out.near != 0) {
    raise_to_bounds_along_body(box, sides, squared);
    out.near = Portable::not_above(squared, limit);
  }
  store(squared, box, out);
}

}  // namespace

void box_gaps(const FramedBox& box, const ByteBoxes& boxes, double squared_reach_m2, BoxGaps& out) {
  gaps_on(box, boxes, squared_reach_m2, out);
}

}  // namespace camway::scene
