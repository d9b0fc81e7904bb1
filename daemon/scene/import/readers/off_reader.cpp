// SPDX-License-Identifier: MIT
#include "daemon/scene/import/readers/off_reader.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/scene/import/readers/decimal.h"
#include "daemon/scene/import/readers/tokens.h"

namespace camway::scene::mesh_readers {
namespace {

/// Words, line by line, without comments.
class Words {
 public:
  explicit Words(std::string_view bytes) : rest_(bytes) {}

  /// The next word on this line, empty if there is none.
  std::string_view next_on_line() { return take_token(line_); }

  /// The next word, on a later line if need be; empty at the end of the file.
  std::string_view next() {
    while (true) {
      const std::string_view word = take_token(line_);
      if (!word.empty() || rest_.empty()) return word;
      next_line();
    }
  }
  void skip_line() { line_ = {}; }
  /// Puts back the unused tail of the last word.
  void put_back(std::string_view tail) {
    const std::size_t size = static_cast<std::size_t>(line_.data() - tail.data()) + line_.size();
    line_ = std::string_view(tail.data(), size);
  }
  [[nodiscard]] std::size_t bytes_left() const { return line_.size() + rest_.size(); }

 private:
  void next_line() {
    line_ = take_line(rest_);
    line_ = line_.substr(0, line_.find('#'));
  }

  std::string_view line_;
  std::string_view rest_;
};

struct Header {
  bool weighted = false;
  std::size_t vertices = 0;
  std::size_t faces = 0;
};

class OffReader {
 public:
  OffReader(std::string_view bytes, MeshCollector& mesh)
      : words_(bytes), size_(bytes.size()), mesh_(mesh) {}

  std::string read() {
    if (std::string error = read_keyword(); !error.empty()) return error;
    if (std::string error = read_counts(); !error.empty()) return error;
    mesh_.reserve_vertices(header_.vertices);
    for (std::size_t i = 0; i < header_.vertices; ++i) {
      if (!read_vertex()) return "ends after " + std::to_string(i) + " vertices";
    }
    for (std::size_t i = 0; i < header_.faces; ++i) {
      if (std::string error = read_face(); !error.empty()) {
        return error + " (face " + std::to_string(i) + ")";
      }
    }
    if (!words_.next().empty()) {
      return "goes on after the " + std::to_string(header_.faces) + " faces that it says it has";
    }
    return "";
  }

 private:
  /// `[ST][C][N][4][n]OFF`, or no keyword.
  std::string read_keyword() {
    const std::string_view word = words_.next();
    const std::size_t off = word.find("OFF");
    if (off == std::string_view::npos) {
      if (!parse_integer(word)) return "is no OFF file: it begins with neither OFF nor a number";
      words_.put_back(word);
      return "";
    }
    std::string_view prefix = word.substr(0, off);
    for (const std::string_view known : {"ST", "C", "N", "4", "n"}) {
      if (!prefix.starts_with(known)) continue;
      prefix.remove_prefix(known.size());
      if (known == "4") header_.weighted = true;
      if (known == "n") of_any_dimension_ = true;
    }
    if (!prefix.empty()) return "is of no kind of OFF that is known";
    words_.put_back(word.substr(off + 3));
    return "";
  }

  std::string read_counts() {
    if (of_any_dimension_) {
      const std::optional<std::int64_t> dimensions = parse_integer(words_.next());
      if (dimensions != 3) return "is not of three dimensions";
    }
    const std::string_view first = words_.next();
    if (first == "BINARY") return "is a binary OFF file, which is not supported";
    std::string_view second = words_.next_on_line();
    const bool on_one_line = !second.empty();
    if (!on_one_line) second = words_.next();
    // The number of edges, which is unused and sometimes missing.
    if (!on_one_line) words_.next();
    words_.skip_line();
    return take_counts(first, second);
  }

  /// A vertex takes at least 2 bytes for each coordinate, a face 2.
  std::string take_counts(std::string_view first, std::string_view second) {
    const std::optional<std::int64_t> vertices = parse_integer(first);
    const std::optional<std::int64_t> faces = parse_integer(second);
    if (!vertices || !faces || *vertices < 0 || *faces < 0) {
      return "its numbers of vertices and faces are missing or out of range";
    }
    header_.vertices = static_cast<std::size_t>(*vertices);
    header_.faces = static_cast<std::size_t>(*faces);
    const std::size_t left = words_.bytes_left() + 1;  // the last end of line may be missing
    if (header_.vertices > left / 6 || header_.faces > left / 2) {
      return "says it has " + std::to_string(*vertices) + " vertices and " +
             std::to_string(*faces) + " faces, in " + std::to_string(size_) + " bytes";
    }
    return "";
  }

  bool read_vertex() {
    Point point{};
    std::string_view word;
    for (double& x : point) {
      word = words_.next();
      x = parse_decimal(word);
    }
    if (header_.weighted) {
      word = words_.next();
      const double weight = parse_decimal(word);
      for (double& x : point) x /= weight;
      mesh_.note_weight();
    }
    if (word.empty()) return false;
    words_.skip_line();
    mesh_.add_vertex(point);
    return true;
  }

  std::string read_face() {
    const std::string_view word = words_.next();
    if (word.empty()) return "ends before its faces do";
    const std::optional<std::int64_t> count = parse_integer(word);
    if (!count || *count < 0) return "has a face without a number of corners";
    const auto size = static_cast<std::size_t>(*count);
    if (size > words_.bytes_left()) return "ends within a face";
    corners_.clear();
    for (std::size_t i = 0; i < size; ++i) {
      const std::string_view corner = words_.next();
      if (corner.empty()) return "ends within a face";
      corners_.push_back(mesh_.vertex(parse_integer(corner).value_or(-1)));
    }
    words_.skip_line();
    mesh_.add_polygon(corners_);
    return "";
  }

  Words words_;
  std::size_t size_;
  MeshCollector& mesh_;
  Header header_;
  bool of_any_dimension_ = false;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

std::string read_off(std::string_view bytes, MeshCollector& mesh) {
  OffReader reader(bytes, mesh);
  mesh.begin_object("<OFFRoot>");
  return reader.read();
}

}  // namespace camway::scene::mesh_readers
