// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "daemon/geometry/types.h"

/// The boxes of the index: eight at a time, a byte per side, rounded outwards.
namespace camway::scene {

/// Number of children of a node, and of boxes that are compared at once.
inline constexpr std::uint32_t kNodeWidth = 8;

/// Eight boxes in steps of a frame, one array per side so that eight are compared at once.
struct ByteBoxes {
  std::array<std::array<std::uint8_t, kNodeWidth>, 3> low{};   ///< [axis][box]
  std::array<std::array<std::uint8_t, kNodeWidth>, 3> high{};  ///< [axis][box]

  bool operator==(const ByteBoxes&) const = default;
};

/// One box of a `ByteBoxes`.
struct ByteBox {
  std::array<std::uint8_t, 3> low{};
  std::array<std::uint8_t, 3> high{};
};

/// 2^exponent. [Limit: -1022 <= exponent <= 1023]
constexpr double power_of_two(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52U);
}

/// The steps of a node's boxes: side `q` on axis k lies at `origin[k] + q·2^exponent[k]`. The steps
/// are powers of two, so that converting a coordinate to steps rounds only once, in the difference.
struct ByteFrame {
  static constexpr int kSteps = 255;
  /// Exponent of the finest steps: it keeps quotients and squares within the range of doubles.
  static constexpr int kMinExponent = -400;

  std::array<double, 3> origin{};
  std::array<std::int16_t, 4> exponent{};  ///< the fourth is 0

  ByteFrame() = default;
  /// The finest frame for `box`; a flat or small box gets coarser steps. Requires a nonempty box.
  explicit ByteFrame(const geometry::Box& box);

  /// `box` with its sides rounded outwards to steps. A true side may lie up to `kByteBoxError` of a
  /// step outside the result. Requires that it lies in the box that the frame was made for.
  [[nodiscard]] ByteBox outside(const geometry::Box& box) const;

  /// A box that surely holds the box that `outside` converted to `bytes`. [Units: metres]
  [[nodiscard]] geometry::Box box_of(const ByteBox& bytes) const;

  bool operator==(const ByteFrame&) const = default;
};

/// The rounding error of `outside` in steps. A difference of doubles of at most 256 steps is wrong
/// by at most 2^-53·2^8 steps before it is rounded outwards, so a true side may lie this far
/// outside.
inline constexpr double kByteBoxError = 0x1p-44;

/// Up to eight children: first nodes, then leaves. The nodes are neighbours in the index, and so
/// are the leaves.
struct IndexNode {
  ByteFrame frame;
  std::uint8_t node_count = 0;
  std::uint8_t child_count = 0;
  std::array<std::uint8_t, 2> unused = {};  ///< 0: files of nodes have no bytes without a value
  std::uint32_t first_node = 0;
  std::uint32_t first_leaf = 0;
  /// boxes of the children; the entries of the leaves have boxes in this frame, too
  ByteBoxes boxes;
  std::uint32_t unused_at_end = 0;

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
