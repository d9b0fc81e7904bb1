// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace camway::scene {

/// Largest distance between cells that is computed; greater ones count as this. Its square, and
/// twice that, fit 16 bits, with which the transform works.
inline constexpr int kMaxCellDistance = 127;
inline constexpr int kMaxSquaredCellDistance = kMaxCellDistance * kMaxCellDistance;

/// A byte for every squared distance between two cells.
using CellDistanceCodes = std::array<std::uint8_t, kMaxSquaredCellDistance + 1>;

/// Computes for every cell of a grid the squared distance to the nearest marked cell: the distance,
/// in cells, between the nearest points of the two, so 0 for neighbours too. Exact, in integers, up
/// to kMaxSquaredCellDistance, which is also the result where nothing is marked.
///
/// `cells` holds a byte for each cell, x runs fastest. It contains marks (0 or 1) before and
/// `codes[squared distance]` after the call. The result does not depend on `threads`. Needs 2 bytes
/// per cell of working memory until it returns.
///
/// The squared distance is a sum over the axes (Felzenszwalb & Huttenlocher 2012, "Distance
/// transforms of sampled functions", section 3). Deviations: distances are between cells, not
/// between their centres, so that k cells along an axis cost max(|k|-1, 0)²; and instead of the
/// lower envelope of parabolas it takes the least of the candidates, 32 columns at a time, nearest
/// first, until none can be less. That is not linear in the worst case (kMaxCellDistance candidates
/// to either side), but needs no division and is several times faster on scenes.
void distance_transform(const std::array<std::int32_t, 3>& size, unsigned threads,
                        const CellDistanceCodes& codes, std::span<std::uint8_t> cells);

}  // namespace camway::scene
