// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/random.h"

/// Clouds of points as files of every format and encoding, for tests and as the corpus of the
/// fuzzer.
namespace camway::scene::point_files {

using PointList = std::vector<std::array<double, 3>>;

/// Returns points in the cube of side 2 * `half` about `middle`, whose coordinates are multiples of
/// 2^-10, so that floats and LAS files hold them as they are.
PointList random_points(camway::testing::Random& random, std::size_t count, double half,
                        const std::array<double, 3>& middle = {});

/// The type of a field of a PCD file.
struct PcdType {
  char type = 'F';
  int bytes = 4;
};

enum class PcdEncoding { kText, kBinary, kCompressed };

/// Writes a PCD file. With `random`, fields stand in any order, with others between them of any
/// size and count.
std::string write_pcd(const PointList& points, PcdEncoding encoding, PcdType type = {},
                      camway::testing::Random* random = nullptr);

/// Writes points in lines, with `separator` between the columns.
std::string write_xyz(const PointList& points, std::string_view separator = " ",
                      std::string_view header = "");

/// A LAS file.
struct LasKind {
  int minor_version = 2;
  int format = 3;
  std::array<double, 3> scale{0x1p-10, 0x1p-10, 0x1p-10};
  std::array<double, 3> offset{};
  int extra_bytes = 0;  ///< of each point
};
std::string write_las(const PointList& points, const LasKind& kind = {});

}  // namespace camway::scene::point_files
