// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace camway::scene {

/// Largest distance between cells that is computed; a larger one counts as this. The transform
/// works with numbers of 16 bits, which hold twice its square.
inline constexpr int kMaxCellDistance = 127;
inline constexpr int kMaxSquaredCellDistance = kMaxCellDistance * kMaxCellDistance;

/// A byte for every squared distance between two cells.
using CellDistanceCodes = std::array<std::uint8_t, kMaxSquaredCellDistance + 1>;

/// Computes, for every cell of a grid, the squared distance to the nearest marked cell. The
/// distance of two cells is that of their nearest points, in cells, so it is 0 for neighbours, too.
/// The result is exact, in integers, up to kMaxSquaredCellDistance, which stands for all larger
/// values and for a grid without a mark.
///
/// `cells` has a byte for each cell; x runs fastest. Before the call it holds marks (0 or 1), and
/// after it `codes[squared distance]`. The result does not depend on `threads`. Needs 2 bytes of
/// working memory per cell. [Limit: threads >= 1]
///
/// The squared distance is a sum over the axes (Felzenszwalb & Huttenlocher 2012, "Distance
/// transforms of sampled functions", section 3). Deviations:
/// - Distances are between cells, not between their centres, so k cells along an axis cost
///   max(|k|-1, 0)².
/// - Instead of the lower envelope of parabolas, the least candidate is taken: nearest first, 32
///   columns at a time, until none can be less. That is not linear in the worst case
///   (kMaxCellDistance candidates to either side), but needs no division and is several times
///   faster on scenes.
void distance_transform(const std::array<std::int32_t, 3>& size, unsigned threads,
                        const CellDistanceCodes& codes, std::span<std::uint8_t> cells);

}  // namespace camway::scene
