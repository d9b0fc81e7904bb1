// SPDX-License-Identifier: MIT
#include "daemon/scene/import/readers/obj_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "daemon/scene/import/readers/decimal.h"
#include "daemon/scene/import/readers/tokens.h"

namespace camway::scene::mesh_readers {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// Splits a file into lines, joining those that end in a backslash to the next.
class Lines {
 public:
  explicit Lines(std::string_view bytes) : rest_(bytes) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
  }

  /// False at the end. `line` is valid until the next call.
  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    line = take_line(rest_);
    if (!line.ends_with('\\')) return true;
    joined_.clear();
    while (line.ends_with('\\')) {
      joined_ += line.substr(0, line.size() - 1);
      joined_ += ' ';
      line = rest_.empty() ? std::string_view() : take_line(rest_);
    }
    joined_ += line;
    line = joined_;
    return true;
  }

 private:
  std::string_view rest_;
  std::string joined_;
};

/// The next word before a comment; empty if there is none.
std::string_view take_word(std::string_view& line) {
  const std::string_view word = take_token(line);
  return word.starts_with('#') ? std::string_view() : word;
}

/// A word that is no number makes the vertex unusable, but it keeps its index.
Point read_vertex(std::string_view line, MeshCollector& mesh) {
  std::array<double, 6> numbers{};
  std::size_t count = 0;
  while (count < numbers.size()) {
    const std::string_view word = take_word(line);
    if (word.empty()) break;
    const double number = parse_decimal(word);
    if (count >= 3 && std::isnan(number)) break;
    numbers[count++] = number;
  }
  if (count < 3) return {kNoNumber, kNoNumber, kNoNumber};
  Point point = {numbers[0], numbers[1], numbers[2]};
  if (count == 4 && numbers[3] != 1.0) {
    mesh.note_weight();
    for (double& x : point) x /= numbers[3];
  }
  return point;
}

std::size_t count_words(std::string_view line) {
  std::size_t count = 0;
  while (!take_word(line).empty()) ++count;
  return count;
}

/// Determines the object that a face belongs to.
class Grouping {
 public:
  explicit Grouping(MeshCollector& mesh) : mesh_(mesh) {}

  void on_object(std::string_view line) {
    const std::string_view name = take_token(line);
    if (!name.empty()) begin_object(name);
  }
  void on_group(std::string_view line) {
    const std::string_view name = trimmed(line);
    if (name == group_) return;
    group_ = name;
    begin_object(name);
  }
  void on_material(std::string_view line) {
    const std::string_view name = trimmed(line);
    if (name.empty() || name == material_) return;
    const bool had_one = !material_.empty();
    material_ = name;
    if (!had_one || !has_faces_) return;  // the object so far is all of this material
    has_faces_ = false;
    const bool no_prefix = object_.empty() || object_ == material_;
    mesh_.begin_object(no_prefix ? material_ : object_.substr(0, kLongestPart) + "/" + material_);
  }
  void on_face() {
    if (!named_) begin_object("defaultobject");
    has_faces_ = true;
  }

 private:
  static constexpr std::size_t kLongestPart = 127;  ///< so that the material's name shows too

  void begin_object(std::string_view name) {
    object_ = name;
    named_ = true;
    has_faces_ = false;
    mesh_.begin_object(name);
  }

  MeshCollector& mesh_;
  std::string object_;
  std::string group_;
  std::string material_;
  bool named_ = false;
  bool has_faces_ = false;
};

/// Second pass: all vertices are known; only the number of vertices so far is counted again.
class FaceReader {
 public:
  explicit FaceReader(MeshCollector& mesh) : mesh_(mesh), grouping_(mesh) {}

  void read(std::string_view line) {
    const std::string_view keyword = take_token(line);
    if (keyword == "v") {
      ++vertices_so_far_;
    } else if (keyword == "f" || keyword == "fo") {
      read_face(line);
    } else if (keyword == "o") {
      grouping_.on_object(line);
    } else if (keyword == "g") {
      grouping_.on_group(line);
    } else if (keyword == "usemtl") {
      grouping_.on_material(line);
    } else if (keyword == "p") {
      mesh_.add_points_and_lines(count_words(line));
    } else if (keyword == "l") {
      mesh_.add_points_and_lines(std::max<std::size_t>(count_words(line), 2) - 1);
    } else if (is_one_of(keyword, kFreeform)) {
      mesh_.add_freeform_surface();
    } else if (!keyword.empty() && !keyword.starts_with('#') && !is_one_of(keyword, kHarmless)) {
      mesh_.add_ignored_statement();
    }
  }

 private:
  /// Statements that begin a curve or a surface, also in the oldest versions.
  static constexpr std::array<std::string_view, 7> kFreeform = {"surf", "curv", "bzp", "bsp",
                                                                "cdc",  "cdp",  "res"};
  /// Known statements that add nothing to the scene.
  static constexpr std::array<std::string_view, 29> kHarmless = {
      "vt",        "vn",  "vp",    "s",     "mg",       "mtllib",   "maplib", "usemap",
      "bevel",     "lod", "ctech", "stech", "c_interp", "d_interp", "cstype", "shadow_obj",
      "trace_obj", "deg", "bmat",  "step",  "parm",     "trim",     "hole",   "scrv",
      "sp",        "end", "con",   "curv2", "csh"};

  template <std::size_t N>
  static bool is_one_of(std::string_view word, const std::array<std::string_view, N>& words) {
    return std::ranges::find(words, word) != words.end();
  }

  void read_face(std::string_view line) {
    corners_.clear();
    while (true) {
      const std::string_view word = take_word(line);
      if (word.empty()) break;
      corners_.push_back(corner(word.substr(0, word.find('/'))));
    }
    grouping_.on_face();
    mesh_.add_polygon(corners_);
  }

  /// Counted from 1, or from the last vertex so far if negative.
  [[nodiscard]] std::uint32_t corner(std::string_view text) const {
    const std::optional<std::int64_t> number = parse_integer(text);
    if (!number || *number == 0) return kNoVertex;
    return mesh_.vertex(*number > 0 ? *number - 1 : vertices_so_far_ + *number);
  }

  MeshCollector& mesh_;
  Grouping grouping_;
  std::int64_t vertices_so_far_ = 0;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

void read_obj(std::string_view bytes, MeshCollector& mesh) {
  std::string_view line;
  for (Lines lines(bytes); lines.next(line);) {
    if (take_token(line) == "v") mesh.add_vertex(read_vertex(line, mesh));
  }
  FaceReader faces(mesh);
  for (Lines lines(bytes); lines.next(line);) faces.read(line);
}

}  // namespace camway::scene::mesh_readers
