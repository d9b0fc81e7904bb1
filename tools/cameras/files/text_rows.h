// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace camway::tools {

/// A line of a table: its words, and its number, from 1.
struct TextRow {
  std::size_t line = 0;
  std::vector<std::string_view> words;
};

/// Returns the lines that have words, which blanks, commas and semicolons separate. A comma within
/// a word where blanks or semicolons separate, too, belongs to the word. Lines that begin with '#'
/// go to `comment`, without it, if there is one.
std::vector<TextRow> rows_of(std::string_view text,
                             const std::function<void(std::string_view)>& comment = {});

/// Reads the words of a row as numbers. Returns why that is not possible, with the line: a word is
/// no number, or there are fewer than `least`. Empty if it is.
std::string read_numbers(const TextRow& row, std::size_t least, std::vector<double>& numbers);

/// Reads a row that has numbers only, as `read_numbers` does, and not more of them than `most`.
std::string read_row(const TextRow& row, std::size_t least, std::size_t most,
                     std::vector<double>& numbers);

/// Writes numbers with blanks between them, so that they read back to the same doubles.
std::string number_row(std::span<const double> numbers, std::string_view separator = " ");
std::string number_text(double number);

}  // namespace camway::tools
