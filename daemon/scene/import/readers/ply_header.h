// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace camway::scene::mesh_readers {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

/// Size of a value in a binary file, in bytes.
std::size_t size_of(PlyType type);

struct PlyProperty {
  std::string_view name;
  PlyType type = PlyType::kInt8;
  std::optional<PlyType> count_type;  ///< type of the length of a list
};

struct PlyElement {
  std::string_view name;
  std::uint64_t count = 0;  ///< as the file says, unchecked
  std::vector<PlyProperty> properties;

  /// Index of the first property that has one of these names.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view a, std::string_view b = "") const;
  /// Least size of one element, in bytes of a binary file or of text.
  [[nodiscard]] std::size_t least_bytes(bool binary) const;
};

struct PlyHeader {
  enum class Encoding { kText, kLittleEndian, kBigEndian };
  Encoding encoding = Encoding::kText;
  std::vector<PlyElement> elements;  ///< their names point into the file
  std::string_view body;             ///< the bytes after the header
};

/// Parses the header of a PLY file (Turk 1994). Lines end as the first one does: LF, CR or CR LF.
/// Returns why the file is refused, or an empty text.
std::string read_ply_header(std::string_view bytes, PlyHeader& header);

}  // namespace camway::scene::mesh_readers
