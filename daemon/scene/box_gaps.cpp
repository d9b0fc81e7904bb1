// SPDX-License-Identifier: MIT
#include "daemon/scene/box_gaps.h"

#include <algorithm>
#include <cstring>
#include <limits>

// Two versions of a function, and the loader takes the one for this processor. Sanitizers run
// before they can cope with that.
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define CAMWAY_FOR_EVERY_PROCESSOR __attribute__((target_clones("avx2", "default")))
#else
#define CAMWAY_FOR_EVERY_PROCESSOR
#endif

namespace camway::scene {
namespace {

// Vectors of GCC and Clang: written once, compiled to what the processor has.
using Floats = float __attribute__((vector_size(32)));
using Ints = std::int32_t __attribute__((vector_size(32)));
using HalfFloats = float __attribute__((vector_size(16)));
using Doubles = double __attribute__((vector_size(32)));
using Longs = std::int64_t __attribute__((vector_size(32)));
using Shorts = std::uint16_t __attribute__((vector_size(16)));
using Bytes = std::uint8_t __attribute__((vector_size(8)));

/// Coordinates beyond so many steps are taken for so many: bounds become smaller, nothing
/// overflows, and what is this far away is far whatever the reach.
constexpr double kFarthestStep = 0x1p60;

/// A coordinate in steps has a rounding of 2^-53 (the difference) and 2^-24 (to float), relative to
/// itself; moving it outwards rounds twice more. 2^-21 is more than all of these; 2^-20 of a step
/// covers `kByteBoxError`.
constexpr float kRelativeMove = 0x1p-21F;
constexpr float kLeastMove = 0x1p-20F;

/// The bound's own error, and twice the rounding of the limit to float.
constexpr double kLimitMove = kBoxGapRelativeError + 0x1p-22;
/// More than any bound, which has at most `kFarthestStep` in each of three axes.
constexpr double kLargestLimit = 0x1p126;

// By reference: by value the calling convention would depend on the processor.
[[gnu::always_inline]] inline void move_down(Doubles& steps, HalfFloats& out) {
  const Doubles farthest = {kFarthestStep, kFarthestStep, kFarthestStep, kFarthestStep};
  steps = steps > farthest ? farthest : steps;
  steps = steps < -farthest ? -farthest : steps;
  const HalfFloats x = __builtin_convertvector(steps, HalfFloats);
  const HalfFloats size = x < 0.0F ? -x : x;
  out = x - (size * kRelativeMove + kLeastMove);
}

[[gnu::always_inline]] inline void to_floats(const std::array<std::uint8_t, kNodeWidth>& steps,
                                             Floats& out) {
  Bytes bytes;
  std::memcpy(&bytes, steps.data(), sizeof bytes);
  // Step by step: GCC 12 takes eight bytes apart one by one otherwise.
  out = __builtin_convertvector(
      __builtin_convertvector(__builtin_convertvector(bytes, Shorts), Ints), Floats);
}

/// Adds the squared gaps on one axis, in units of which a step has `weight`; a product with a power
/// of two is exact. Sides of the box are given moved down: `minus_to` is the upper one, negated.
[[gnu::always_inline]] inline void add_gaps(const ByteBoxes& boxes, std::size_t axis, float from,
                                            float minus_to, float weight, Floats& sum) {
  Floats begin, end;
  to_floats(boxes.low[axis], begin);
  to_floats(boxes.high[axis], end);
  const Floats below = begin + minus_to;
  const Floats above = from - end;
  Floats gap = below > above ? below : above;
  gap = gap > 0.0F ? gap : Floats{};
  gap *= weight;
  sum += gap * gap;
}

/// Bit i of the result: lane i is not above `limit`.
[[gnu::always_inline]] inline unsigned not_above(const Floats& lanes, float limit) {
  constexpr Ints kBits = {1, 2, 4, 8, 16, 32, 64, 128};
  const Ints above = (lanes > limit) & kBits;
  Longs halves;
  std::memcpy(&halves, &above, sizeof halves);
  const auto joined = static_cast<std::uint64_t>(halves[0] | halves[1] | halves[2] | halves[3]);
  return ~static_cast<unsigned>(joined | joined >> 32U) & 0xFFU;
}

}  // namespace

CAMWAY_FOR_EVERY_PROCESSOR
void box_gaps(const ByteFrame& frame, const ByteBoxes& boxes, const BoxSides& box,
              double squared_reach_m2, BoxGaps& out) {
  const Doubles origin = {frame.origin[0], frame.origin[1], frame.origin[2], 0.0};
  const Longs exponent = {frame.exponent[0], frame.exponent[1], frame.exponent[2], 0};
  const Doubles steps_per_m = reinterpret_cast<Doubles>((1023 - exponent) << 52);
  Doubles low, high;
  std::memcpy(&low, box.low_m.data(), sizeof low);
  std::memcpy(&high, box.high_m.data(), sizeof high);
  // Both sides as numbers that are moved down.
  Doubles down = (low - origin) * steps_per_m;
  Doubles up = (origin - high) * steps_per_m;
  HalfFloats from, minus_to;
  move_down(down, from);
  move_down(up, minus_to);
  const int largest = std::max({frame.exponent[0], frame.exponent[1], frame.exponent[2]});
  const Doubles weights = reinterpret_cast<Doubles>((1023 - largest + exponent) << 52);
  const HalfFloats weight = __builtin_convertvector(weights, HalfFloats);
  Floats sum = {};
  add_gaps(boxes, 0, from[0], minus_to[0], weight[0], sum);
  add_gaps(boxes, 1, from[1], minus_to[1], weight[1], sum);
  add_gaps(boxes, 2, from[2], minus_to[2], weight[2], sum);
  std::memcpy(out.squared.data(), &sum, sizeof sum);
  out.square_m2 = power_of_two(2 * largest);
  const double limit = squared_reach_m2 * power_of_two(-2 * largest) * (1.0 + kLimitMove);
  out.near = not_above(
      sum, static_cast<float>(std::min(limit, kLargestLimit)) + std::numeric_limits<float>::min());
}

}  // namespace camway::scene
