// SPDX-License-Identifier: MIT
#include "daemon/scene/import/unigrafix/unigrafix_parser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "daemon/scene/import/readers/decimal.h"
#include "daemon/scene/import/readers/tokens.h"

namespace camway::scene::unigrafix {
namespace {

using mesh_readers::parse_decimal;
using mesh_readers::parse_integer;

constexpr std::size_t kDeepestInclude = 16;
constexpr std::size_t kDeepestDefinition = 64;
constexpr std::int64_t kLargestArray = 1'000'000'000;

std::string quoted(std::string_view word) {
  constexpr std::size_t kLongest = 60;
  if (word.empty()) return "the end of the file";
  return "'" + std::string(word.substr(0, kLongest)) + "'";
}

std::string fault_at(const StatementScanner& words, const std::string& what) {
  return words.fault().empty() ? words.place() + ": " + what : words.fault();
}

std::string expect(StatementScanner& words, std::string_view wanted) {
  const std::string_view word = words.next();
  if (word == wanted) return "";
  return fault_at(words, "'" + std::string(wanted) + "' should be here, not " + quoted(word));
}

bool is_mark(std::string_view word) {
  return word.empty() || word == "(" || word == ")" || word == ";";
}

/// Whether a word begins a transform, as "-rx" does and "-1" does not.
bool is_transform(std::string_view word) {
  return word.size() >= 2 && word[0] == '-' &&
         ((word[1] >= 'a' && word[1] <= 'z') || word[1] == 'M') && word != "-inf" && word != "-nan";
}

/// The name of what a statement defines; empty if it has none.
std::string optional_name(StatementScanner& words) {
  return is_mark(words.peek()) ? "" : std::string(words.next());
}

std::optional<double> number_in(std::string_view word) {
  const double value = parse_decimal(word);
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

/// The axis that a letter names: x, y or z.
std::optional<std::size_t> axis_of(char letter) {
  if (letter < 'x' || letter > 'z') return std::nullopt;
  return static_cast<std::size_t>(letter - 'x');
}

Point unit_vector(std::size_t axis) {
  Point vector{};
  vector[axis] = 1.0;
  return vector;
}

bool is_zero(const Point& vector) { return vector == Point{}; }

using Numbers = std::vector<double>;

/// The map of a transform with one letter for its kind and one for its axis; nothing if there is no
/// such transform.
std::optional<PlacementMap> map_of(char kind, char axis_letter, const Numbers& n) {
  const std::optional<std::size_t> axis = axis_of(axis_letter);
  const Point along =
      axis ? unit_vector(*axis) : (n.size() < 3 ? Point{} : Point{n[0], n[1], n[2]});
  if (axis && n.size() == (kind == 'm' ? 0U : 1U)) {
    if (kind == 's') return PlacementMap::scaling_along(along, n[0]);
    if (kind == 'm') return PlacementMap::scaling_along(along, -1.0);
    if (kind == 'r') return PlacementMap::rotation(along, n[0]);
    if (kind == 't')
      return PlacementMap::translation({along[0] * n[0], along[1] * n[0], along[2] * n[0]});
  }
  if (axis_letter == 'a') {
    if (kind == 's' && n.size() == 1) return PlacementMap::scaling({n[0], n[0], n[0]});
    if (kind == 'm' && n.empty()) return PlacementMap::scaling({-1.0, -1.0, -1.0});
    if (kind == 't' && n.size() == 3) return PlacementMap::translation(along);
  }
  if (axis_letter != 'v' || is_zero(along)) return std::nullopt;
  if (kind == 's' && n.size() == 4) return PlacementMap::scaling_along(along, n[3]);
  if (kind == 'r' && n.size() == 4) return PlacementMap::rotation(along, n[3]);
  if (kind == 'm' && n.size() == 3) return PlacementMap::scaling_along(along, -1.0);
  if (kind == 't' && n.size() == 3) return PlacementMap::translation(along);
  return std::nullopt;
}

struct Matrix {
  Affine entries{};
  bool is_ambiguous = false;  ///< rows might as well be columns
};

/// `size` is 3 or 4. Nothing if the matrix is projective.
std::optional<Matrix> matrix_of(const Numbers& n, std::size_t size) {
  const auto at = [&](std::size_t row, std::size_t column) { return n[row * size + column]; };
  bool has_row = false;
  bool has_column = false;
  if (size == 4) {
    if (n[15] != 1.0) return std::nullopt;
    for (std::size_t i = 0; i < 3; ++i) {
      has_row = has_row || at(3, i) != 0.0;
      has_column = has_column || at(i, 3) != 0.0;
    }
    if (has_row && has_column) return std::nullopt;
  }
  Matrix matrix;
  bool is_symmetric = true;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      matrix.entries[i][j] = has_column ? at(i, j) : at(j, i);
      is_symmetric = is_symmetric && at(i, j) == at(j, i);
    }
    if (size == 4) matrix.entries[i][3] = has_column ? at(i, 3) : at(3, i);
  }
  matrix.is_ambiguous = !has_row && !has_column && !is_symmetric;
  return matrix;
}

}  // namespace

UnigrafixParser::UnigrafixParser(Definition& scene, const OpenInclude& open_include)
    : scene_(scene), open_include_(open_include) {}

std::string UnigrafixParser::parse(std::string_view text) {
  open_ = {&scene_};
  Fault fault = parse_file(text, "");
  return fault.empty() ? scene_.complete() : fault;
}

UnigrafixParser::Fault UnigrafixParser::parse_file(std::string_view text, const std::string& file) {
  files_.push_back(file);
  const std::size_t definitions = open_.size();
  StatementScanner words(text, file);
  while (!words.peek().empty()) {
    Fault fault = parse_statement(words);
    if (!fault.empty()) return fault;
  }
  if (!words.fault().empty()) return words.fault();
  if (open_.size() != definitions) return fault_at(words, "a definition has no end");
  files_.pop_back();
  return "";
}

UnigrafixParser::Fault UnigrafixParser::parse_statement(StatementScanner& words) {
  const std::string_view keyword = words.next();
  if (keyword == "v") return parse_vertex(words);
  if (keyword == "f") return parse_face_or_wire(words, true);
  if (keyword == "w") return parse_face_or_wire(words, false);
  if (keyword == "i") return parse_use(words, false);
  if (keyword == "a") return parse_use(words, true);
  if (keyword == "def") return parse_definition(words);
  if (keyword == "end") return end_definition(words);
  if (keyword == "include") return parse_include(words);
  if (keyword == "(") return skip_text(words);
  if (keyword == ";") return "";
  if (keyword.starts_with('#')) {
    parse_preprocessor_line(words, keyword);
    return "";
  }
  if (keyword == "c" || keyword == "c_rgb") return skip_statement(words);
  if (keyword == "l" || keyword == "cam") {
    ++counts_.lights_and_cameras;
    return skip_statement(words);
  }
  if (keyword == "execute") {
    return fault_at(words, "'execute' runs a program, which a scene file may not");
  }
  return fault_at(words, quoted(keyword) + " begins no statement of UniGrafix");
}

UnigrafixParser::Fault UnigrafixParser::parse_vertex(StatementScanner& words) {
  const std::string_view name = words.next();
  if (is_mark(name)) return fault_at(words, "a vertex has no name");
  Point point{};
  for (double& coordinate : point) {
    const std::string_view word = words.next();
    const std::optional<double> number = number_in(word);
    if (!number) {
      return fault_at(
          words, "vertex " + quoted(name) + " has " + quoted(word) + " in place of a coordinate");
    }
    coordinate = *number;
  }
  if (!open_.back()->define_vertex(name, point)) {
    return fault_at(words, "there is a vertex " + quoted(name) + " already");
  }
  return expect(words, ";");
}

UnigrafixParser::Fault UnigrafixParser::parse_face_or_wire(StatementScanner& words, bool is_face) {
  optional_name(words);
  std::vector<std::uint32_t> corners;
  std::vector<std::size_t> ends;
  Fault fault = parse_contours(words, corners, ends);
  if (!fault.empty()) return fault;
  if (is_face) {
    open_.back()->add_face(corners, ends);
  } else {
    open_.back()->add_lines(ends.size());
  }
  optional_name(words);  // its colour
  return expect(words, ";");
}

UnigrafixParser::Fault UnigrafixParser::parse_contours(StatementScanner& words,
                                                       std::vector<std::uint32_t>& corners,
                                                       std::vector<std::size_t>& ends) {
  do {
    Fault fault = expect(words, "(");
    if (!fault.empty()) return fault;
    const std::size_t before = corners.size();
    while (!is_mark(words.peek())) {
      const std::string_view name = words.next();
      corners.push_back(open_.back()->vertex(name, words.place()));
    }
    fault = expect(words, ")");
    if (!fault.empty()) return fault;
    if (corners.size() == before) return fault_at(words, "a contour has no vertex");
    ends.push_back(corners.size());
  } while (words.peek() == "(");
  return "";
}

UnigrafixParser::Fault UnigrafixParser::parse_use(StatementScanner& words, bool is_array) {
  Use use;
  use.name = optional_name(words);
  Fault fault = expect(words, "(");
  if (!fault.empty()) return fault;
  const std::string_view name = words.next();
  use.definition = open_.back()->find(name);
  if (use.definition == nullptr) {
    return fault_at(words, "there is no complete definition " + quoted(name) + " above");
  }
  if (use.definition->depth() >= kDeepestDefinition) {
    return fault_at(
        words, "instances are nested more than " + std::to_string(kDeepestDefinition) + " deep");
  }
  if (use.name.empty()) use.name = name;
  if (!is_transform(words.peek())) optional_name(words);  // its colour
  fault = parse_map(words, ")", use.place);
  if (!fault.empty()) return fault;
  if (is_array) {
    const std::string_view word = words.next();
    const std::optional<std::int64_t> count = parse_integer(word);
    if (!count || *count < 0 || *count > kLargestArray) {
      return fault_at(words, quoted(word) + " is no size of an array");
    }
    use.count = static_cast<std::uint64_t>(*count);
  }
  fault = is_array ? parse_map(words, ";", use.step) : expect(words, ";");
  if (fault.empty()) open_.back()->add_use(std::move(use));
  return fault;
}

UnigrafixParser::Fault UnigrafixParser::parse_map(StatementScanner& words, std::string_view end,
                                                  PlacementMap& map) {
  while (is_transform(words.peek())) {
    Fault fault = parse_transform(words, map);
    if (!fault.empty()) return fault;
  }
  return expect(words, end);
}

UnigrafixParser::Fault UnigrafixParser::parse_transform(StatementScanner& words,
                                                        PlacementMap& map) {
  const std::string_view name = words.next();
  Numbers numbers;
  while (!is_mark(words.peek()) && !is_transform(words.peek())) {
    const std::optional<double> number = number_in(words.peek());
    if (!number) break;
    words.next();
    numbers.push_back(*number);
  }
  const std::size_t size = name == "-M3" ? 3 : (name == "-M4" ? 4 : 0);
  if (size > 0 && numbers.size() == size * size) {
    const std::optional<Matrix> matrix = matrix_of(numbers, size);
    if (!matrix) return fault_at(words, "the matrix of " + quoted(name) + " is projective");
    if (matrix->is_ambiguous) ++counts_.matrices_without_offset;
    map = map.then(PlacementMap::affine(matrix->entries));
    return "";
  }
  const std::optional<PlacementMap> next =
      name.size() == 3 ? map_of(name[1], name[2], numbers) : std::nullopt;
  if (!next) {
    return fault_at(words, "there is no transform " + quoted(name) + " of " +
                               std::to_string(numbers.size()) + " numbers");
  }
  map = map.then(*next);
  return "";
}

UnigrafixParser::Fault UnigrafixParser::parse_definition(StatementScanner& words) {
  const std::string_view name = words.next();
  if (is_mark(name)) return fault_at(words, "a definition has no name");
  if (open_.size() > kDeepestDefinition) {
    return fault_at(
        words, "definitions are nested more than " + std::to_string(kDeepestDefinition) + " deep");
  }
  Definition* const begun = open_.back()->begin_definition(name);
  if (begun == nullptr) {
    return fault_at(words, "there is a definition " + quoted(name) + " already");
  }
  open_.push_back(begun);
  return expect(words, ";");
}

UnigrafixParser::Fault UnigrafixParser::end_definition(StatementScanner& words) {
  if (open_.size() == 1) return fault_at(words, "'end' without a definition");
  Fault fault = open_.back()->complete();
  if (!fault.empty()) return fault;
  open_.pop_back();
  return expect(words, ";");
}

UnigrafixParser::Fault UnigrafixParser::parse_include(StatementScanner& words) {
  std::string_view name = words.next();
  if (name.size() >= 2 && name.front() == '"' && name.back() == '"') {
    name = name.substr(1, name.size() - 2);
  }
  if (is_mark(name)) return fault_at(words, "'include' without a file");
  if (files_.size() > kDeepestInclude) {
    return fault_at(words,
                    "files are included more than " + std::to_string(kDeepestInclude) + " deep");
  }
  const base::Result<IncludedFile> opened = open_include_(files_.back(), std::string(name));
  if (!opened) return fault_at(words, quoted(name) + " " + opened.error);
  Fault fault = expect(words, ";");
  if (!fault.empty()) return fault;
  ++counts_.includes;
  return parse_file(opened->text, opened->name);
}

UnigrafixParser::Fault UnigrafixParser::skip_text(StatementScanner& words) {
  for (std::size_t depth = 1; depth > 0;) {
    const std::string_view word = words.next();
    if (word.empty()) return fault_at(words, "a text in parentheses has no end");
    if (word == "(") ++depth;
    if (word == ")") --depth;
  }
  return "";
}

UnigrafixParser::Fault UnigrafixParser::skip_statement(StatementScanner& words) {
  for (;;) {
    const std::string_view word = words.next();
    if (word == ";") return "";
    if (word.empty()) return fault_at(words, "a statement has no ';'");
  }
}

void UnigrafixParser::parse_preprocessor_line(StatementScanner& words,
                                              std::string_view first_word) {
  std::string_view rest = words.rest_of_line();
  first_word.remove_prefix(1);
  const std::string_view number = first_word.empty() ? mesh_readers::take_token(rest) : first_word;
  const std::optional<std::int64_t> line = parse_integer(number);
  std::string_view file = mesh_readers::take_token(rest);
  if (file.size() >= 2 && file.front() == '"' && file.back() == '"') {
    file = file.substr(1, file.size() - 2);
  }
  if (line && *line > 0) words.continue_at(static_cast<std::uint64_t>(*line), file);
}

}  // namespace camway::scene::unigrafix
