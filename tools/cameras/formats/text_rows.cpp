// SPDX-License-Identifier: MIT
#include "tools/cameras/formats/text_rows.h"

#include <fmt/format.h>

#include <cmath>

#include "daemon/scene/import/readers/decimal.h"
#include "daemon/scene/import/readers/tokens.h"

namespace camway::tools {
namespace {

bool separates(char c) { return scene::mesh_readers::is_blank(c) || c == ',' || c == ';'; }

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < line.size();) {
    std::size_t end = at;
    while (end < line.size() && !separates(line[end])) ++end;
    if (end > at) words.push_back(line.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

}  // namespace

std::vector<TextRow> rows_of(std::string_view text,
                             const std::function<void(std::string_view)>& comment) {
  std::vector<TextRow> rows;
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::string_view content =
        scene::mesh_readers::trimmed(scene::mesh_readers::take_line(text));
    if (content.starts_with('#')) {
      if (comment) comment(content.substr(1));
      continue;
    }
    std::vector<std::string_view> words = words_of(content);
    if (!words.empty()) rows.push_back({line, std::move(words)});
  }
  return rows;
}

std::string read_numbers(const TextRow& row, std::size_t least, std::vector<double>& numbers) {
  numbers.clear();
  for (const std::string_view word : row.words) {
    const double number = scene::mesh_readers::parse_decimal(word);
    if (!std::isfinite(number)) {
      if (numbers.size() >= least) break;
      return fmt::format("line {}: '{}' is no number", row.line, word);
    }
    numbers.push_back(number);
  }
  if (numbers.size() >= least) return "";
  return fmt::format("line {}: has {} numbers, not {}", row.line, numbers.size(), least);
}

std::string number_text(double number) { return fmt::format("{}", number); }

std::string number_row(std::span<const double> numbers, std::string_view separator) {
  return fmt::format("{}", fmt::join(numbers, separator));
}

}  // namespace camway::tools
