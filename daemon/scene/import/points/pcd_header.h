// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"

namespace camway::scene::point_readers {

/// A field of the points of a PCD file.
struct PcdField {
  std::string_view name;
  char type = 'F';         ///< 'F', 'I' or 'U'
  std::size_t bytes = 4;   ///< of one value
  std::size_t count = 1;   ///< values of each point
  std::size_t offset = 0;  ///< bytes of a point before it
  std::size_t column = 0;  ///< values of a point before it
};

enum class PcdData : std::uint8_t { kAscii, kBinary, kCompressed };

/// The header of a PCD file.
struct PcdHeader {
  std::vector<PcdField> fields;
  std::array<std::size_t, 3> xyz{};  ///< the fields x, y and z
  std::size_t point_bytes = 0;
  std::size_t columns = 0;  ///< values of a point
  std::size_t points = 0;
  PcdData data = PcdData::kAscii;
  std::size_t lines = 0;       ///< of the header
  bool has_viewpoint = false;  ///< whether it names one that is not the origin, not turned
};

/// Reads the header of a PCD file (0.5 to 0.7) and removes it from `bytes`. Fails, with the line,
/// if there are no fields x, y and z of one number each, of a type that exists. The number of
/// points is not checked against the bytes.
base::Result<PcdHeader> take_pcd_header(std::string_view& bytes);

}  // namespace camway::scene::point_readers
