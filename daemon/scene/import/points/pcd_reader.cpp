// SPDX-License-Identifier: MIT
#include "daemon/scene/import/points/pcd_reader.h"

#include <fmt/format.h>
#include <liblzf/lzf.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/import/points/pcd_header.h"
#include "daemon/scene/import/points/point_reader.h"
#include "daemon/scene/import/readers/tokens.h"

namespace camway::scene::point_readers {
namespace {

namespace layout = import_record;
using mesh_readers::take_line;
using mesh_readers::take_token;
static_assert(std::endian::native == std::endian::little, "as PCL writes on all usual machines");

/// LZF makes at most 264 bytes of 3.
constexpr std::size_t kMostTimes = 88;
constexpr std::size_t kLongestShown = 40;

template <class T>
double value_as(const char* data) {
  T value{};
  std::memcpy(&value, data, sizeof value);
  return static_cast<double>(value);
}

/// The number of a field. Requires a type that `take_pcd_header` accepts for x, y and z.
double value_of(const PcdField& field, const char* data) {
  switch (field.bytes) {
    case 1:
      return field.type == 'I' ? value_as<std::int8_t>(data) : value_as<std::uint8_t>(data);
    case 2:
      return field.type == 'I' ? value_as<std::int16_t>(data) : value_as<std::uint16_t>(data);
    case 4:
      return field.type == 'F'   ? value_as<float>(data)
             : field.type == 'I' ? value_as<std::int32_t>(data)
                                 : value_as<std::uint32_t>(data);
    default:
      return field.type == 'F'   ? value_as<double>(data)
             : field.type == 'I' ? value_as<std::int64_t>(data)
                                 : value_as<std::uint64_t>(data);
  }
}

class PcdReader {
 public:
  explicit PcdReader(PcdHeader header, std::size_t first_byte)
      : header_(std::move(header)), first_byte_(first_byte) {}

  base::Result<layout::Record> read(std::string_view data) {
    std::string fault;
    switch (header_.data) {
      case PcdData::kAscii:
        fault = read_ascii(data);
        break;
      case PcdData::kBinary:
        fault = read_binary(data);
        break;
      case PcdData::kCompressed:
        fault = read_compressed(data);
        break;
    }
    if (!fault.empty()) return base::Failure{std::move(fault)};
    finish();
    return std::move(record_);
  }

 private:
  std::string read_ascii(std::string_view data) {
    // A point has a digit and a blank for each value at least; the last end of line may be missing.
    if (header_.points > (data.size() + 1) / (2 * header_.columns)) return too_short(data.size());
    record_.vertices.reserve(header_.points);
    std::size_t line = header_.lines;
    while (!data.empty()) {
      ++line;
      std::string_view rest = take_line(data);
      if (mesh_readers::is_blank(rest)) continue;
      if (record_.vertices.size() == header_.points) {
        return fmt::format("line {}: goes on after the {} points that it says it has", line,
                           header_.points);
      }
      if (std::string fault = add_line(rest); !fault.empty()) {
        return fmt::format("line {}: {}", line, fault);
      }
    }
    if (record_.vertices.size() == header_.points) return {};
    return fmt::format("line {}: ends after {} of {} points", line, record_.vertices.size(),
                       header_.points);
  }

  std::string add_line(std::string_view line) {
    layout::Vertex point{};
    std::size_t column = 0;
    for (auto word = take_token(line); !word.empty(); word = take_token(line), ++column) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (field(k).column != column) continue;
        const std::optional<double> value = number_in(word);
        if (!value) return fmt::format("'{}' is no number", word.substr(0, kLongestShown));
        point[k] = *value;
      }
    }
    if (column != header_.columns) {
      return fmt::format("has {} values, and a point has {}", column, header_.columns);
    }
    record_.vertices.push_back(point);
    return {};
  }

  std::string read_binary(std::string_view data) {
    if (header_.points > data.size() / header_.point_bytes) return too_short(data.size());
    const std::size_t used = header_.points * header_.point_bytes;
    if (std::string fault = fault_in_rest(data.substr(used), used); !fault.empty()) return fault;
    record_.vertices.resize(header_.points);
    for (std::size_t i = 0; i < header_.points; ++i) {
      const char* const point = data.data() + i * header_.point_bytes;
      for (std::size_t k = 0; k < 3; ++k) {
        record_.vertices[i][k] = value_of(field(k), point + field(k).offset);
      }
    }
    return {};
  }

  /// The values of each field follow one another, field by field.
  std::string read_compressed(std::string_view data) {
    constexpr std::size_t kSizes = 2 * sizeof(std::uint32_t);
    if (data.size() < kSizes) return too_short(data.size());
    std::uint32_t packed = 0;
    std::uint32_t unpacked = 0;
    std::memcpy(&packed, data.data(), sizeof packed);
    std::memcpy(&unpacked, data.data() + sizeof packed, sizeof unpacked);
    data.remove_prefix(kSizes);
    if (packed > data.size()) return too_short(data.size());
    if (header_.points > unpacked / header_.point_bytes ||
        header_.points * header_.point_bytes != unpacked) {
      return fmt::format("byte {}: {} points of {} bytes are not the {} bytes that are compressed",
                         first_byte_, header_.points, header_.point_bytes, unpacked);
    }
    if (unpacked / kMostTimes > packed) {
      return fmt::format("byte {}: {} bytes cannot be {} compressed ones", first_byte_, unpacked,
                         packed);
    }
    std::string values(unpacked, '\0');
    if (lzf_decompress(data.data(), packed, values.data(), unpacked) != unpacked) {
      return fmt::format("byte {}: the compressed points are damaged", first_byte_ + kSizes);
    }
    const std::size_t used = kSizes + packed;
    if (std::string fault = fault_in_rest(data.substr(packed), used); !fault.empty()) return fault;
    add_fields(values);
    return {};
  }

  void add_fields(std::string_view values) {
    record_.vertices.resize(header_.points);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t begin = header_.points * field(k).offset;
      for (std::size_t i = 0; i < header_.points; ++i) {
        record_.vertices[i][k] = value_of(field(k), values.data() + begin + i * field(k).bytes);
      }
    }
  }

  /// Zeros may follow the points, where a writer filled its last page.
  [[nodiscard]] std::string fault_in_rest(std::string_view rest, std::size_t used) const {
    if (std::ranges::all_of(rest, [](char c) { return c == '\0' || c == '\n' || c == '\r'; })) {
      return {};
    }
    return fmt::format("byte {}: goes on after the {} points that it says it has",
                       first_byte_ + used, header_.points);
  }

  [[nodiscard]] std::string too_short(std::size_t size) const {
    return fmt::format(
        "says it has {} points of {} values and {} bytes, and from byte {} on there "
        "are {} bytes",
        header_.points, header_.columns, header_.point_bytes, first_byte_, size);
  }

  [[nodiscard]] const PcdField& field(std::size_t k) const {
    return header_.fields[header_.xyz[k]];
  }

  void finish() {
    const bool is_ascii = header_.data == PcdData::kAscii;
    record_.text = std::string("PCD, ") + (is_ascii                           ? "text"
                                           : header_.data == PcdData::kBinary ? "binary"
                                                                              : "compressed");
    bool is_rounded = is_ascii;
    for (std::size_t k = 0; k < 3; ++k) {
      is_rounded = is_rounded || (field(k).type != 'F' && field(k).bytes == sizeof(std::int64_t));
    }
    if (is_rounded) record_.header.relative_rounding = geometry::kUnitRoundoff;
    if (header_.has_viewpoint) {
      record_.notes = "the file's VIEWPOINT is not applied: points are taken as they are\n";
    }
  }

  PcdHeader header_;
  std::size_t first_byte_;
  layout::Record record_;
};

}  // namespace

base::Result<layout::Record> read_pcd(std::string_view bytes) {
  std::string_view data = bytes;
  base::Result<PcdHeader> header = take_pcd_header(data);
  if (!header) return base::Failure{std::move(header.error)};
  return PcdReader(*std::move(header), bytes.size() - data.size()).read(data);
}

}  // namespace camway::scene::point_readers
