// SPDX-License-Identifier: MIT
#include "daemon/scene/import/readers/ply_reader.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/import/readers/decimal.h"
#include "daemon/scene/import/readers/ply_header.h"
#include "daemon/scene/import/readers/tokens.h"

namespace camway::scene::mesh_readers {
namespace {

/// The values of a text body, word by word.
class TextValues {
 public:
  explicit TextValues(std::string_view body) : rest_(body) {}
  /// Returns false at the end. A word that is no number gives a NaN.
  bool next(PlyType /*type*/, double& value) {
    const std::string_view word = take_token(rest_);
    value = parse_decimal(word);
    return !word.empty();
  }
  [[nodiscard]] std::size_t bytes_left() const { return rest_.size() + 1; }
  [[nodiscard]] bool is_at_end() const { return is_blank(rest_); }

 private:
  std::string_view rest_;
};

/// The values of a binary body. All are exact as doubles.
template <bool kBigEndian>
class BinaryValues {
 public:
  explicit BinaryValues(std::string_view body) : rest_(body) {}
  bool next(PlyType type, double& value) {
    const std::size_t size = size_of(type);
    if (rest_.size() < size) return false;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
      bits = bits << 8 | static_cast<std::uint8_t>(rest_[kBigEndian ? i : size - 1 - i]);
    }
    rest_.remove_prefix(size);
    value = number(type, bits);
    return true;
  }
  [[nodiscard]] std::size_t bytes_left() const { return rest_.size(); }
  [[nodiscard]] bool is_at_end() const { return is_blank(rest_); }

 private:
  static double number(PlyType type, std::uint64_t bits) {
    switch (type) {
      case PlyType::kInt8:
        return static_cast<std::int8_t>(bits);
      case PlyType::kUint8:
        return static_cast<std::uint8_t>(bits);
      case PlyType::kInt16:
        return static_cast<std::int16_t>(bits);
      case PlyType::kUint16:
        return static_cast<std::uint16_t>(bits);
      case PlyType::kInt32:
        return static_cast<std::int32_t>(bits);
      case PlyType::kUint32:
        return static_cast<std::uint32_t>(bits);
      case PlyType::kFloat:
        return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
      case PlyType::kDouble:
        break;
    }
    return std::bit_cast<double>(bits);
  }

  std::string_view rest_;
};

/// Reads the body; vertices come before faces, whatever the order in the file.
template <class Values>
class BodyReader {
 public:
  BodyReader(const PlyHeader& header, MeshCollector& mesh) : header_(header), mesh_(mesh) {}

  std::string read() {
    std::string error = walk(/*first=*/true);
    if (error.empty() && faces_came_first_) error = walk(/*first=*/false);
    if (!error.empty()) return error;
    if (!has_vertices_) return "has no element 'vertex'";
    if (!has_faces_) mesh_.add_points_and_lines(mesh_.vertex_count());
    return "";
  }

 private:
  static constexpr bool kBinary = !std::is_same_v<Values, TextValues>;

  std::string walk(bool first) {
    Values values(header_.body);
    bool met_vertices = false;
    for (const PlyElement& element : header_.elements) {
      const std::size_t least = element.least_bytes(kBinary);
      if (least == 0) continue;  // it takes no bytes
      if (element.count > values.bytes_left() / least) return too_many(element);
      const bool is_vertex = element.name == "vertex";
      const bool is_face = element.name == "face" || element.name == "tristrips";
      std::string error;
      if (is_vertex && first) {
        if (has_vertices_) return "has the element 'vertex' twice";
        error = read_vertices(element, values);
      } else if (is_face && has_vertices_ && (first || !met_vertices)) {
        error = read_faces(element, values);
      } else {
        if (is_face && first) faces_came_first_ = true;
        if (element.name == "edge" && first) mesh_.add_points_and_lines(element.count);
        error = skip(element, values);
      }
      met_vertices = met_vertices || is_vertex;
      if (!error.empty()) return error;
    }
    return values.is_at_end() ? "" : "goes on after the elements that its header promises";
  }

  static std::string too_many(const PlyElement& element) {
    return "says it has " + std::to_string(element.count) + " elements '" +
           std::string(element.name.substr(0, 40)) + "', more than its bytes can hold";
  }

  static std::string truncated(const PlyElement& element, std::uint64_t number) {
    return "ends within '" + std::string(element.name.substr(0, 40)) + "' " +
           std::to_string(number);
  }

  /// Reads one property: into `list`, unless null, if it is a list, else into `scalar`.
  bool take(Values& values, const PlyProperty& property, double& scalar,
            std::vector<double>* list) {
    if (!property.count_type) return values.next(property.type, scalar);
    double count = 0.0;
    if (!values.next(*property.count_type, count)) return false;
    // False for NaN. A value takes a byte at least.
    if (!(count >= 0.0 && count <= static_cast<double>(values.bytes_left()))) return false;
    for (auto left = static_cast<std::uint64_t>(count); left > 0; --left) {
      double value = 0.0;
      if (!values.next(property.type, value)) return false;
      if (list != nullptr) list->push_back(value);
    }
    return true;
  }

  std::string skip(const PlyElement& element, Values& values) {
    double ignored = 0.0;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) {
        if (!take(values, property, ignored, nullptr)) return truncated(element, i);
      }
    }
    return "";
  }

  std::string read_vertices(const PlyElement& element, Values& values) {
    has_vertices_ = true;
    std::array<std::size_t, 3> axis{};
    for (std::size_t k = 0; k < 3; ++k) {
      constexpr std::array<std::string_view, 3> kAxes = {"x", "y", "z"};
      const std::optional<std::size_t> position = element.find(kAxes[k]);
      if (!position || element.properties[*position].count_type) {
        return "has vertices without " + std::string(kAxes[k]);
      }
      axis[k] = *position;
    }
    mesh_.reserve_vertices(element.count);
    std::vector<double> scalars(element.properties.size());
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (std::size_t p = 0; p < scalars.size(); ++p) {
        if (!take(values, element.properties[p], scalars[p], nullptr)) return truncated(element, i);
      }
      mesh_.add_vertex({scalars[axis[0]], scalars[axis[1]], scalars[axis[2]]});
    }
    return "";
  }

  std::string read_faces(const PlyElement& element, Values& values) {
    const std::optional<std::size_t> position = element.find("vertex_indices", "vertex_index");
    if (!position || !element.properties[*position].count_type) {
      return "has elements '" + std::string(element.name) + "' without vertex_indices";
    }
    has_faces_ = has_faces_ || element.count > 0;
    std::vector<double> indices;
    double ignored = 0.0;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      indices.clear();
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        if (!take(values, element.properties[p], ignored, p == *position ? &indices : nullptr)) {
          return truncated(element, i);
        }
      }
      element.name == "face" ? add_face(indices) : add_strips(indices);
    }
    return "";
  }

  [[nodiscard]] std::uint32_t vertex(double index) const {
    // False for NaN.
    const bool is_number = index >= 0.0 && index < 0x1p32 && index == std::floor(index);
    return is_number ? mesh_.vertex(static_cast<std::int64_t>(index)) : kNoVertex;
  }

  void add_face(const std::vector<double>& indices) {
    corners_.clear();
    for (const double index : indices) corners_.push_back(vertex(index));
    mesh_.add_polygon(corners_);
  }

  /// Every three indices in a row are a triangle, -1 begins the next strip.
  void add_strips(const std::vector<double>& indices) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i < indices.size(); ++i) {
      if (indices[i] == -1.0) {
        begin = i + 1;
      } else if (i >= begin + 2) {
        const bool odd = (i - begin) % 2 == 1;
        const std::array<std::uint32_t, 3> corners = {vertex(indices[i - 2]),
                                                      vertex(indices[i - (odd ? 0 : 1)]),
                                                      vertex(indices[i - (odd ? 1 : 0)])};
        mesh_.add_polygon(corners);
      }
    }
  }

  const PlyHeader& header_;
  MeshCollector& mesh_;
  bool has_vertices_ = false;
  bool has_faces_ = false;
  bool faces_came_first_ = false;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

std::string read_ply(std::string_view bytes, MeshCollector& mesh, PlyKind& kind) {
  PlyHeader header;
  if (std::string error = read_ply_header(bytes, header); !error.empty()) return error;
  switch (header.encoding) {
    case PlyHeader::Encoding::kText:
      kind = {"PLY, text", geometry::kUnitRoundoff};
      return BodyReader<TextValues>(header, mesh).read();
    case PlyHeader::Encoding::kLittleEndian:
      kind = {"PLY, binary", 0.0};
      return BodyReader<BinaryValues<false>>(header, mesh).read();
    case PlyHeader::Encoding::kBigEndian:
      break;
  }
  kind = {"PLY, binary, big-endian", 0.0};
  return BodyReader<BinaryValues<true>>(header, mesh).read();
}

}  // namespace camway::scene::mesh_readers
