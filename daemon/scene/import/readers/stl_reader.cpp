// SPDX-License-Identifier: MIT
#include "daemon/scene/import/readers/stl_reader.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/scene/import/readers/decimal.h"
#include "daemon/scene/import/readers/tokens.h"

namespace camway::scene::mesh_readers {
namespace {

constexpr std::size_t kHeaderBytes = 84;  ///< 80 of anything and the number of facets
constexpr std::size_t kFacetBytes = 50;   ///< normal, three vertices, two bytes of attributes
constexpr std::size_t kNormalBytes = 12;

std::uint32_t little_endian_word(std::string_view bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i > 0; --i) value = value << 8 | static_cast<std::uint8_t>(bytes[i - 1]);
  return value;
}

/// Size of a binary file with this header, in bytes.
std::size_t promised_size(std::string_view bytes) {
  return kHeaderBytes + kFacetBytes * std::size_t{little_endian_word(bytes.substr(80))};
}

bool begins_as_text(std::string_view bytes) {
  return equals_ignoring_case(take_token(bytes).substr(0, 5), "solid");
}

std::string read_binary(std::string_view bytes, MeshCollector& mesh) {
  if (promised_size(bytes) > bytes.size()) {
    return "says it has " + std::to_string(little_endian_word(bytes.substr(80))) + " facets, in " +
           std::to_string(bytes.size()) + " bytes";
  }
  const std::size_t facets = little_endian_word(bytes.substr(80));
  if (!is_blank(bytes.substr(promised_size(bytes)))) {
    return "goes on after the " + std::to_string(facets) + " facets that it says it has";
  }
  mesh.reserve_vertices(3 * facets);
  for (std::size_t i = 0; i < facets; ++i) {
    std::string_view at = bytes.substr(kHeaderBytes + i * kFacetBytes + kNormalBytes);
    std::array<std::uint32_t, 3> corners{};
    for (std::uint32_t& corner : corners) {
      Point point{};
      for (double& x : point) {
        x = static_cast<double>(std::bit_cast<float>(little_endian_word(at)));
        at.remove_prefix(4);
      }
      corner = mesh.add_vertex(point);
    }
    mesh.add_polygon(corners);
  }
  return "";
}

/// Ignores words that it does not need (`outer loop`, `normal`, extensions).
class TextReader {
 public:
  TextReader(std::string_view bytes, MeshCollector& mesh) : rest_(bytes), mesh_(mesh) {}

  std::string read() {
    while (true) {
      const std::string_view word = take_token(rest_);
      if (word.empty()) return in_facet_ ? "ends within a facet" : "";
      if (equals_ignoring_case(word, "vertex")) {
        if (!in_facet_) return "has a vertex outside a facet" + place();
        read_vertex();
      } else if (equals_ignoring_case(word, "facet")) {
        if (in_facet_) return "has a facet that does not end" + place();
        in_facet_ = true;
      } else if (equals_ignoring_case(word, "endfacet")) {
        if (std::string error = end_facet(); !error.empty()) return error;
      } else if (equals_ignoring_case(word, "solid")) {
        begin_solid();
      } else if (equals_ignoring_case(word, "endsolid")) {
        rest_of_line();  // the name again, which may be "solid"
      }
    }
  }

 private:
  std::string_view rest_of_line() { return rest_.empty() ? std::string_view() : take_line(rest_); }

  void begin_solid() {
    std::string_view name = rest_of_line();
    mesh_.begin_object(take_token(name));
  }

  void read_vertex() {
    Point point{};
    for (double& x : point) x = parse_decimal(take_token(rest_));
    corners_.push_back(mesh_.add_vertex(point));
  }

  std::string end_facet() {
    if (!in_facet_ || corners_.size() < 3) return "has a facet without three vertices" + place();
    mesh_.add_polygon(corners_);
    corners_.clear();
    in_facet_ = false;
    ++facets_;
    return "";
  }

  [[nodiscard]] std::string place() const { return " (after " + std::to_string(facets_) + ")"; }

  std::string_view rest_;
  MeshCollector& mesh_;
  bool in_facet_ = false;
  std::uint64_t facets_ = 0;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

bool is_binary_stl(std::string_view bytes) {
  if (bytes.size() < kHeaderBytes) return false;
  return promised_size(bytes) == bytes.size() || !begins_as_text(bytes);
}

std::string read_stl(std::string_view bytes, MeshCollector& mesh) {
  if (is_binary_stl(bytes)) return read_binary(bytes, mesh);
  if (!begins_as_text(bytes)) return "is no STL file: neither text nor long enough to be binary";
  return TextReader(bytes, mesh).read();
}

}  // namespace camway::scene::mesh_readers
