// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string_view>

namespace camway::scene::mesh_readers {

/// Whether `c` separates words in the text formats. NUL does, too: no number or name contains it.
constexpr bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f' || c == '\0';
}

/// `text` without the mark that some editors put before UTF-8.
constexpr std::string_view without_bom(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

/// Removes the next word from `text` and returns it; empty exactly if there is none.
inline std::string_view take_token(std::string_view& text) {
  std::size_t begin = 0;
  while (begin < text.size() && is_blank(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && !is_blank(text[end])) ++end;
  const std::string_view token = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return token;
}

/// Removes the next line from `text` and returns it without its end: LF, CR or CR LF. Requires that
/// `text` is not empty.
inline std::string_view take_line(std::string_view& text) {
  std::size_t end = 0;
  while (end < text.size() && text[end] != '\n' && text[end] != '\r') ++end;
  const std::string_view line = text.substr(0, end);
  const bool both = text.substr(end).starts_with("\r\n");
  text.remove_prefix(end == text.size() ? end : end + (both ? 2 : 1));
  return line;
}

/// `text` without the blanks at both ends.
constexpr std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Compares ASCII letters without case, in any locale. Requires that `lower` is in lower case.
inline bool equals_ignoring_case(std::string_view text, std::string_view lower) {
  if (text.size() != lower.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if ((c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c) != lower[i]) return false;
  }
  return true;
}

/// Whether `rest` holds only blanks. Anything else after the faces that a header promises could be
/// more of them.
constexpr bool is_blank(std::string_view rest) { return trimmed(rest).empty(); }

}  // namespace camway::scene::mesh_readers
