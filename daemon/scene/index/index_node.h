// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "daemon/geometry/types.h"

/// How the index keeps boxes: eight at a time, a byte per side, rounded outwards.
namespace camway::scene {

/// Children of a node, and boxes that are asked together.
inline constexpr std::uint32_t kNodeWidth = 8;

/// Eight boxes as steps of a frame, one array per side so that eight are compared at once.
struct ByteBoxes {
  std::array<std::array<std::uint8_t, kNodeWidth>, 3> low{};   ///< [axis][box]
  std::array<std::array<std::uint8_t, kNodeWidth>, 3> high{};  ///< [axis][box]

  bool operator==(const ByteBoxes&) const = default;
};

/// One of them.
struct ByteBox {
  std::array<std::uint8_t, 3> low{};
  std::array<std::uint8_t, 3> high{};
};

/// 2^exponent. [Limit: -1022 <= exponent <= 1023]
constexpr double power_of_two(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52U);
}

/// Where the steps of a node's boxes are: side `q` on axis k lies at `origin[k] + q·2^exponent[k]`.
/// The steps are powers of two, so that going into the frame rounds once, in the difference.
struct ByteFrame {
  static constexpr int kSteps = 255;
  /// Steps are not made finer than this: it keeps quotients and squares inside the doubles.
  static constexpr int kMinExponent = -400;

  std::array<double, 3> origin{};
  std::array<std::int16_t, 4> exponent{};  ///< the fourth is 0

  ByteFrame() = default;
  /// The frame with the finest steps in which `box` fits. Precondition: `box` is not empty.
  explicit ByteFrame(const geometry::Box& box);

  /// `box` with its sides rounded outwards to steps, and up to `kByteBoxError` of a step inwards.
  /// Precondition: it lies in the box that the frame was made for.
  [[nodiscard]] ByteBox outside(const geometry::Box& box) const;

  /// A box that surely holds what `outside` was given, metres.
  [[nodiscard]] geometry::Box box_of(const ByteBox& bytes) const;

  bool operator==(const ByteFrame&) const = default;
};

/// A difference of doubles of at most 256 steps is wrong by at most 2^-53·2^8 steps before it is
/// rounded to a step outwards, so that a true side may lie this many steps outside.
inline constexpr double kByteBoxError = 0x1p-44;

/// Up to eight children: first those that are nodes, then those that are leaves. The nodes are
/// neighbours in the index, and so are the leaves.
struct IndexNode {
  ByteFrame frame;
  std::uint8_t node_count = 0;
  std::uint8_t child_count = 0;
  std::uint32_t first_node = 0;
  std::uint32_t first_leaf = 0;
  ByteBoxes boxes;  ///< of the children; the entries of its leaves are in the same frame

  bool operator==(const IndexNode&) const = default;
};

inline void set_box(ByteBoxes& boxes, std::size_t slot, const ByteBox& box) {
  for (std::size_t k = 0; k < 3; ++k) {
    boxes.low[k][slot] = box.low[k];
    boxes.high[k][slot] = box.high[k];
  }
}

inline ByteBox get_box(const ByteBoxes& boxes, std::size_t slot) {
  ByteBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.low[k] = boxes.low[k][slot];
    box.high[k] = boxes.high[k][slot];
  }
  return box;
}

}  // namespace camway::scene
