// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace camway::scene {

/// Distances between cells are known up to this many cells; what is further counts as this far.
/// The square and twice the square fit 16 bits, so that the transform works in those.
inline constexpr int kMaxCellDistance = 127;
inline constexpr int kMaxSquaredCellDistance = kMaxCellDistance * kMaxCellDistance;

/// A byte for every squared distance between two cells.
using CellDistanceCodes = std::array<std::uint8_t, kMaxSquaredCellDistance + 1>;

/// For every cell of a grid the squared distance from it to the nearest marked cell, in cells,
/// between the nearest points of the two: 0 for neighbours too. Exact, in integers, up to
/// kMaxSquaredCellDistance, which also stands where nothing is marked.
///
/// `cells` holds a byte for each cell, x runs fastest; it goes in as marks (0 or 1) and comes out
/// as `codes[squared distance]`. The result does not depend on `threads`. Needs 2 bytes a cell of
/// working memory, returned at the end.
///
/// The squared distance splits into axes (Felzenszwalb & Huttenlocher 2012, "Distance transforms of
/// sampled functions", section 3). Deviations: between cells, not between their centres, so that
/// what is k apart on an axis costs max(|k|-1, 0)²; and in place of the lower envelope of parabolas
/// the least of the candidates, 32 columns at a time and nearest first, ending where none can be
/// less. That is not linear in the worst case (kMaxCellDistance candidates to either side), but it
/// needs no division and is several times faster on scenes.
void distance_transform(const std::array<std::int32_t, 3>& size, unsigned threads,
                        const CellDistanceCodes& codes, std::span<std::uint8_t> cells);

}  // namespace camway::scene
