// SPDX-License-Identifier: MIT
#include "daemon/scene/import/readers/ply_header.h"

#include <array>
#include <utility>

#include "daemon/scene/import/readers/decimal.h"
#include "daemon/scene/import/readers/tokens.h"

namespace camway::scene::mesh_readers {
namespace {

std::optional<PlyType> type_named(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, PlyType>, 16> kNames = {{
      {"char", PlyType::kInt8},
      {"uchar", PlyType::kUint8},
      {"short", PlyType::kInt16},
      {"ushort", PlyType::kUint16},
      {"int", PlyType::kInt32},
      {"uint", PlyType::kUint32},
      {"float", PlyType::kFloat},
      {"double", PlyType::kDouble},
      {"int8", PlyType::kInt8},
      {"uint8", PlyType::kUint8},
      {"int16", PlyType::kInt16},
      {"uint16", PlyType::kUint16},
      {"int32", PlyType::kInt32},
      {"uint32", PlyType::kUint32},
      {"float32", PlyType::kFloat},
      {"float64", PlyType::kDouble},
  }};
  for (const auto& [known, type] : kNames) {
    if (name == known) return type;
  }
  return std::nullopt;
}

/// The end of a line in this file, empty if the first line does not end.
std::string_view line_end_of(std::string_view bytes) {
  const std::size_t end = bytes.find_first_of("\r\n");
  if (end == std::string_view::npos) return {};
  return bytes.substr(end, bytes.substr(end).starts_with("\r\n") ? 2 : 1);
}

std::string quoted(std::string_view text) { return "'" + std::string(text.substr(0, 40)) + "'"; }

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, PlyHeader& header)
      : rest_(bytes), line_end_(line_end_of(bytes)), header_(header) {}

  std::string read() {
    std::string_view line;
    if (!next(line) || trimmed(line) != "ply") return "is no PLY file: its first line is not 'ply'";
    while (next(line)) {
      const std::string_view keyword = take_token(line);
      std::string error;
      if (keyword == "end_header") {
        if (!encoded_) return "has a header without a format";
        header_.body = rest_;
        return "";
      }
      if (keyword == "format") error = read_format(line);
      if (keyword == "element") error = read_element(line);
      if (keyword == "property") error = read_property(line);
      // All other lines are "comment", "obj_info" or extensions without data.
      if (!error.empty()) return error;
    }
    return "has a header without an end";
  }

 private:
  bool next(std::string_view& line) {
    if (line_end_.empty()) return false;
    const std::size_t end = rest_.find(line_end_);
    if (end == std::string_view::npos) return false;
    line = rest_.substr(0, end);
    rest_.remove_prefix(end + line_end_.size());
    return true;
  }

  std::string read_format(std::string_view line) {
    const std::string_view name = take_token(line);
    encoded_ = true;
    if (name == "ascii") {
      header_.encoding = PlyHeader::Encoding::kText;
    } else if (name == "binary_little_endian") {
      header_.encoding = PlyHeader::Encoding::kLittleEndian;
    } else if (name == "binary_big_endian") {
      header_.encoding = PlyHeader::Encoding::kBigEndian;
    } else {
      return "is of the unknown format " + quoted(name);
    }
    return "";
  }

  std::string read_element(std::string_view line) {
    PlyElement element;
    element.name = take_token(line);
    const std::string_view number = take_token(line);
    const std::optional<std::int64_t> count = parse_integer(number);
    if (!count || *count < 0) {
      return "has elements " + quoted(element.name) + " without a number of them";
    }
    element.count = static_cast<std::uint64_t>(*count);
    header_.elements.push_back(std::move(element));
    return "";
  }

  std::string read_property(std::string_view line) {
    if (header_.elements.empty()) return "has a property of no element";
    PlyProperty property;
    std::string_view type = take_token(line);
    if (type == "list") {
      const std::string_view count_type = take_token(line);
      property.count_type = type_named(count_type);
      const bool whole = property.count_type && property.count_type != PlyType::kFloat &&
                         property.count_type != PlyType::kDouble;
      if (!whole) return "has lists counted in the unknown type " + quoted(count_type);
      type = take_token(line);
    }
    const std::optional<PlyType> known = type_named(type);
    if (!known) return "has a property of the unknown type " + quoted(type);
    property.type = *known;
    property.name = take_token(line);
    header_.elements.back().properties.push_back(property);
    return "";
  }

  std::string_view rest_;
  std::string_view line_end_;
  PlyHeader& header_;
  bool encoded_ = false;
};

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat:
      return 4;
    case PlyType::kDouble:
      break;
  }
  return 8;
}

std::optional<std::size_t> PlyElement::find(std::string_view a, std::string_view b) const {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == a || (!b.empty() && properties[i].name == b)) return i;
  }
  return std::nullopt;
}

std::size_t PlyElement::least_bytes(bool binary) const {
  std::size_t sum = 0;
  for (const PlyProperty& property : properties) {
    sum += binary ? size_of(property.count_type.value_or(property.type)) : 2;  // digit and blank
  }
  return sum;
}

std::string read_ply_header(std::string_view bytes, PlyHeader& header) {
  return HeaderReader(bytes, header).read();
}

}  // namespace camway::scene::mesh_readers
