// SPDX-License-Identifier: MIT
#include "tools/cameras/files/text_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "daemon/scene/import/readers/decimal.h"
#include "daemon/scene/import/readers/tokens.h"

namespace camway::tools {
namespace {

std::vector<std::string_view> split(std::string_view line, bool at_commas) {
  const auto separates = [&](char c) {
    return scene::mesh_readers::is_blank(c) || c == ';' || (at_commas && c == ',');
  };
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < line.size();) {
    std::size_t end = at;
    while (end < line.size() && !separates(line[end])) ++end;
    if (end > at) words.push_back(line.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

/// Commas separate words, but not where other characters do and commas are within the words: these
/// would be decimal commas, and a number would become two.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words = split(line, false);
  const bool has_decimal_commas =
      words.size() > 1 && std::ranges::any_of(words, [](std::string_view word) {
        while (word.ends_with(',')) word.remove_suffix(1);
        return word.find(',', 1) != std::string_view::npos;
      });
  return has_decimal_commas ? words : split(line, true);
}

}  // namespace

std::vector<TextRow> rows_of(std::string_view text,
                             const std::function<void(std::string_view)>& comment) {
  text = scene::mesh_readers::without_bom(text);
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
      return fmt::format("line {}: '{}' is no number{}", row.line, word,
                         word.find(',') != std::string_view::npos ? ": decimals need a point" : "");
    }
    numbers.push_back(number);
  }
  if (numbers.size() >= least) return "";
  return fmt::format("line {}: has {} numbers, not {}", row.line, numbers.size(), least);
}

std::string read_row(const TextRow& row, std::size_t least, std::size_t most,
                     std::vector<double>& numbers) {
  std::string fault = read_numbers(row, row.words.size(), numbers);
  if (!fault.empty() || (numbers.size() >= least && numbers.size() <= most)) return fault;
  const std::string wanted =
      least == most ? std::to_string(least) : fmt::format("{} to {}", least, most);
  return fmt::format("line {}: has {} numbers, not {}", row.line, numbers.size(), wanted);
}

std::string number_text(double number) { return fmt::format("{}", number); }

std::string number_row(std::span<const double> numbers, std::string_view separator) {
  return fmt::format("{}", fmt::join(numbers, separator));
}

}  // namespace camway::tools
