// SPDX-License-Identifier: MIT
#include "daemon/scene/import/points/las_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

#include "daemon/geometry/rounding.h"

namespace camway::scene::point_readers {
namespace {

namespace layout = import_record;
static_assert(std::endian::native == std::endian::little, "as LAS files are");

// Offsets in the public header block (ASPRS, "LAS Specification 1.4 - R15", tables 3 and 4).
constexpr std::size_t kMinorVersionAt = 25;
constexpr std::size_t kPointsAt = 96;
constexpr std::size_t kFormatAt = 104;
constexpr std::size_t kRecordBytesAt = 105;
constexpr std::size_t kOldCountAt = 107;
constexpr std::size_t kScaleAt = 131;
constexpr std::size_t kOffsetAt = 155;
constexpr std::size_t kCountAt = 247;
constexpr std::size_t kLeastHeaderBytes = 227;
constexpr std::size_t kNewHeaderBytes = 375;  ///< of version 1.4
constexpr unsigned kNewestMinorVersion = 4;
/// The bits of the format with which LAZ marks compressed points.
constexpr unsigned kCompressed = 0xC0;
/// Bytes of a record of each format.
constexpr std::array<unsigned, 11> kFormatBytes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

template <class T>
T at(std::string_view bytes, std::size_t offset) {
  T value{};
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

struct Header {
  std::size_t first_byte = 0;
  std::size_t record_bytes = 0;
  std::uint64_t points = 0;
  std::array<double, 3> scale{};
  std::array<double, 3> offset{};
  unsigned minor_version = 0;
  unsigned format = 0;
};

std::string fault_in_version(std::string_view bytes) {
  if (!bytes.starts_with("LASF")) return "is no LAS file: it does not begin with LASF";
  if (bytes.size() < kLeastHeaderBytes) {
    return fmt::format("ends at byte {}, within its header of {}", bytes.size(), kLeastHeaderBytes);
  }
  const unsigned major = at<std::uint8_t>(bytes, kMinorVersionAt - 1);
  const unsigned minor = at<std::uint8_t>(bytes, kMinorVersionAt);
  if (major != 1 || minor > kNewestMinorVersion) {
    return fmt::format("is of LAS version {}.{}; 1.0 to 1.4 are read", major, minor);
  }
  if (minor == kNewestMinorVersion && bytes.size() < kNewHeaderBytes) {
    return fmt::format("ends at byte {}, within its header of {}", bytes.size(), kNewHeaderBytes);
  }
  return {};
}

/// Requires bytes without `fault_in_version`.
Header header_in(std::string_view bytes) {
  Header header;
  header.first_byte = at<std::uint32_t>(bytes, kPointsAt);
  header.record_bytes = at<std::uint16_t>(bytes, kRecordBytesAt);
  header.points = at<std::uint32_t>(bytes, kOldCountAt);
  header.scale = at<std::array<double, 3>>(bytes, kScaleAt);
  header.offset = at<std::array<double, 3>>(bytes, kOffsetAt);
  header.minor_version = at<std::uint8_t>(bytes, kMinorVersionAt);
  header.format = at<std::uint8_t>(bytes, kFormatAt);
  if (header.minor_version == kNewestMinorVersion) {
    const auto points = at<std::uint64_t>(bytes, kCountAt);
    if (points != 0) header.points = points;
  }
  return header;
}

std::string fault_in(const Header& header, std::size_t size) {
  if ((header.format & kCompressed) != 0) {
    return "holds compressed points (LAZ): decompress it, with laszip, las2las or CloudCompare";
  }
  if (header.format >= kFormatBytes.size()) {
    return fmt::format("byte {}: points of format {} are unknown", kFormatAt, header.format);
  }
  if (header.record_bytes < kFormatBytes[header.format]) {
    return fmt::format("byte {}: a point of format {} has {} bytes, not {}", kRecordBytesAt,
                       header.format, kFormatBytes[header.format], header.record_bytes);
  }
  const auto is_sound = [](double number) { return std::isfinite(number); };
  if (!std::ranges::all_of(header.scale, [](double s) { return std::isfinite(s) && s != 0.0; }) ||
      !std::ranges::all_of(header.offset, is_sound)) {
    return fmt::format("byte {}: scale and offset are no usable numbers", kScaleAt);
  }
  if (header.first_byte < kLeastHeaderBytes || header.first_byte > size) {
    return fmt::format("byte {}: points begin at byte {} of {}", kPointsAt, header.first_byte,
                       size);
  }
  const std::size_t room = (size - header.first_byte) / header.record_bytes;
  if (header.points > room) {
    return fmt::format(
        "says it has {} points of {} bytes, and from byte {} on there is room for {}",
        header.points, header.record_bytes, header.first_byte, room);
  }
  return header.points == 0 ? "holds no point" : "";
}

}  // namespace

base::Result<layout::Record> read_las(std::string_view bytes) {
  if (std::string fault = fault_in_version(bytes); !fault.empty()) return base::Failure{fault};
  const Header header = header_in(bytes);
  if (std::string fault = fault_in(header, bytes.size()); !fault.empty()) {
    return base::Failure{fault};
  }
  layout::Record record;
  record.vertices.reserve(static_cast<std::size_t>(header.points));
  double largest_product = 0.0;
  for (std::size_t i = 0; i < header.points; ++i) {
    const auto whole =
        at<std::array<std::int32_t, 3>>(bytes, header.first_byte + i * header.record_bytes);
    layout::Vertex point{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double product = whole[k] * header.scale[k];
      largest_product = std::max(largest_product, std::abs(product));
      point[k] = product + header.offset[k];
    }
    record.vertices.push_back(point);
  }
  record.text = fmt::format("LAS 1.{}, points of format {}", header.minor_version, header.format);
  record.notes = "units and axes of LAS files are not read: see --scale and --up\n";
  // The product rounds, and the sum.
  record.header.relative_rounding = geometry::kUnitRoundoff;
  if (std::isfinite(largest_product)) {
    record.header.absolute_rounding = geometry::kUnitRoundoff * largest_product;
  }
  return record;
}

}  // namespace camway::scene::point_readers
