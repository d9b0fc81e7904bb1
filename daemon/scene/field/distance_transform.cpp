// SPDX-License-Identifier: MIT
#include "daemon/scene/field/distance_transform.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <vector>

#include "daemon/base/parallel_chunks.h"

namespace camway::scene {
namespace {

/// Eight columns at a time: a vector type of GCC and Clang, compiled to what the processor has.
using Eight = std::int16_t __attribute__((vector_size(16)));
constexpr std::size_t kLanes = 32;

/// Written out instead of an array: GCC keeps single vectors in registers, but not arrays of them.
struct Lanes {
  Eight a, b, c, d;
};
static_assert(sizeof(Lanes) == kLanes * sizeof(std::int16_t));

Eight load(const std::int16_t* values) {
  Eight result;
  std::memcpy(&result, values, sizeof result);
  return result;
}

Lanes load_lanes(const std::int16_t* values) {
  return {load(values), load(values + 8), load(values + 16), load(values + 24)};
}

Eight smaller(Eight x, Eight y) { return x < y ? x : y; }
Eight larger(Eight x, Eight y) { return x > y ? x : y; }

bool any_above(const Lanes& lanes, std::int16_t limit) {
  const Eight above = larger(larger(lanes.a, lanes.b), larger(lanes.c, lanes.d)) > limit;
  std::array<std::uint64_t, 2> bits;
  static_assert(sizeof bits == sizeof above);
  std::memcpy(bits.data(), &above, sizeof above);
  return (bits[0] | bits[1]) != 0;
}

/// Takes the minimum with two rows that are equally far away; `cost` is that of the distance.
void take_least(Lanes& least, const std::int16_t* before, const std::int16_t* after,
                std::int16_t cost) {
  const Lanes x = load_lanes(before);
  const Lanes y = load_lanes(after);
  least.a = smaller(least.a, smaller(x.a, y.a) + cost);
  least.b = smaller(least.b, smaller(x.b, y.b) + cost);
  least.c = smaller(least.c, smaller(x.c, y.c) + cost);
  least.d = smaller(least.d, smaller(x.d, y.d) + cost);
}

/// Rows of values, `stride` apart.
struct Rows {
  const std::int16_t* data;
  std::size_t stride;
  std::ptrdiff_t count;

  [[nodiscard]] const std::int16_t* row(std::ptrdiff_t index) const {
    return data + index * static_cast<std::ptrdiff_t>(stride);
  }
};

/// A row beyond the grid.
constexpr std::array<std::int16_t, kLanes> kNothing = [] {
  std::array<std::int16_t, kLanes> lanes{};
  lanes.fill(kMaxSquaredCellDistance);
  return lanes;
}();

/// The least, over all rows, of a row's value plus the cost of its distance from `row`, for kLanes
/// columns.
Lanes least_over_rows(const Rows& rows, std::ptrdiff_t row) {
  constexpr int kStepsBetweenLooks = 4;
  Lanes least = load_lanes(rows.row(row));
  const std::ptrdiff_t furthest =
      std::min<std::ptrdiff_t>(std::max(row, rows.count - 1 - row), kMaxCellDistance);
  for (int away = 1; away <= furthest; ++away) {
    const auto cost = static_cast<std::int16_t>((away - 1) * (away - 1));
    if (away % kStepsBetweenLooks == 1 && !any_above(least, cost)) break;
    take_least(least, row >= away ? rows.row(row - away) : kNothing.data(),
               row + away < rows.count ? rows.row(row + away) : kNothing.data(), cost);
  }
  return least;
}

/// Squared distances from a mark to the cells behind it in its row, and to those before it.
struct Slopes {
  std::array<std::int16_t, kMaxCellDistance> rising;
  std::array<std::int16_t, kMaxCellDistance> falling;
};
constexpr Slopes kSlopes = [] {
  Slopes slopes{};
  for (std::size_t i = 0; i < slopes.rising.size(); ++i) {
    slopes.rising[i] = static_cast<std::int16_t>(i * i);
    slopes.falling[slopes.falling.size() - 1 - i] = slopes.rising[i];
  }
  return slopes;
}();

void fill_after_mark(std::span<std::int16_t> gap) {
  std::copy_n(kSlopes.rising.begin(), std::min(gap.size(), kSlopes.rising.size()), gap.begin());
}

void fill_before_mark(std::span<std::int16_t> gap) {
  const std::size_t count = std::min(gap.size(), kSlopes.falling.size());
  std::copy_n(kSlopes.falling.end() - static_cast<std::ptrdiff_t>(count), count,
              gap.end() - static_cast<std::ptrdiff_t>(count));
}

/// Computes squared distances along one row of marks. `out` may be longer; nothing is marked there.
void transform_row(std::span<const std::uint8_t> marks, std::span<std::int16_t> out) {
  std::fill(out.begin(), out.end(), std::int16_t{kMaxSquaredCellDistance});
  bool after_mark = false;
  for (std::size_t begin = 0; begin < marks.size(); ++begin) {
    const void* found = std::memchr(&marks[begin], 1, marks.size() - begin);
    const std::size_t end =
        found == nullptr
            ? marks.size()
            : static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - marks.data());
    const std::span<std::int16_t> gap = out.subspan(begin, end - begin);
    const bool before_mark = end < marks.size();
    const std::size_t half = after_mark && before_mark ? gap.size() / 2 : 0;
    if (after_mark) fill_after_mark(gap.first(gap.size() - half));
    if (before_mark) {
      fill_before_mark(after_mark ? gap.last(half) : gap);
      out[end] = 0;
    }
    after_mark = true;
    begin = end;
  }
}

class Transform {
 public:
  Transform(const std::array<std::int32_t, 3>& size, unsigned workers,
            std::span<std::uint8_t> cells)
      : nx_(static_cast<std::size_t>(size[0])),
        ny_(static_cast<std::size_t>(size[1])),
        nz_(static_cast<std::size_t>(size[2])),
        width_((nx_ + kLanes - 1) / kLanes * kLanes),
        cells_(cells),
        planar_(width_ * ny_ * nz_),
        slices_(workers, std::vector<std::int16_t>(width_ * ny_)) {}

  /// Along x and y, for all cells of one z.
  void transform_slice(unsigned worker, std::size_t z) {
    std::vector<std::int16_t>& slice = slices_[worker];
    for (std::size_t y = 0; y < ny_; ++y) {
      transform_row(cells_.subspan((z * ny_ + y) * nx_, nx_),
                    std::span(slice).subspan(y * width_, width_));
    }
    for (std::size_t x = 0; x < width_; x += kLanes) {
      const Rows rows{slice.data() + x, width_, static_cast<std::ptrdiff_t>(ny_)};
      for (std::size_t y = 0; y < ny_; ++y) {
        const Lanes least = least_over_rows(rows, static_cast<std::ptrdiff_t>(y));
        std::memcpy(planar_.data() + position(x, y, z), &least, sizeof least);
      }
    }
  }

  /// Along z, for all cells of one y.
  void transform_upright(std::size_t y, const CellDistanceCodes& codes) {
    for (std::size_t x = 0; x < width_; x += kLanes) {
      const Rows rows{planar_.data() + position(x, y, 0), width_ * ny_,
                      static_cast<std::ptrdiff_t>(nz_)};
      const std::size_t used = std::min(kLanes, nx_ - x);
      for (std::size_t z = 0; z < nz_; ++z) {
        const Lanes least = least_over_rows(rows, static_cast<std::ptrdiff_t>(z));
        const std::span<std::uint8_t> out = cells_.subspan((z * ny_ + y) * nx_ + x, used);
        std::array<std::int16_t, kLanes> squared;
        std::memcpy(squared.data(), &least, sizeof least);
        for (std::size_t i = 0; i < used; ++i) out[i] = codes[static_cast<std::size_t>(squared[i])];
      }
    }
  }

 private:
  [[nodiscard]] std::ptrdiff_t position(std::size_t x, std::size_t y, std::size_t z) const {
    return static_cast<std::ptrdiff_t>((z * ny_ + y) * width_ + x);
  }

  std::size_t nx_;
  std::size_t ny_;
  std::size_t nz_;
  std::size_t width_;  ///< width of a row, in whole lanes
  std::span<std::uint8_t> cells_;
  std::vector<std::int16_t> planar_;               ///< least over x and y
  std::vector<std::vector<std::int16_t>> slices_;  ///< least over x, one for each worker
};

}  // namespace

void distance_transform(const std::array<std::int32_t, 3>& size, unsigned threads,
                        const CellDistanceCodes& codes, std::span<std::uint8_t> cells) {
  const unsigned workers = base::chunk_threads(threads);
  Transform transform(size, workers, cells);
  base::for_each_chunk(
      workers, static_cast<std::size_t>(size[2]),
      [&](unsigned worker, std::size_t z) { transform.transform_slice(worker, z); });
  base::for_each_chunk(workers, static_cast<std::size_t>(size[1]),
                       [&](unsigned, std::size_t y) { transform.transform_upright(y, codes); });
}

}  // namespace camway::scene
