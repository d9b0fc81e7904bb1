// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace camway::scene::unigrafix {

/// Splits a UniGrafix file into words: "(", ")", ";", and what blanks separate. Comments in braces,
/// which nest, separate words. The text must outlive it.
class StatementScanner {
 public:
  StatementScanner(std::string_view text, std::string file) : rest_(text), file_(std::move(file)) {}

  /// The next word; empty at the end of the file and after a fault.
  std::string_view next();
  /// The word that `next` returns.
  std::string_view peek();
  /// Skips to the end of the line; after '#', which begins a line of the C preprocessor.
  std::string_view rest_of_line();

  /// Names the place of the last word: "line 12" or "chair.ug, line 3".
  [[nodiscard]] std::string place() const;
  /// Places of words that follow are those of `line` and so on in `file`, as a line of the C
  /// preprocessor says; an empty name keeps the file.
  void continue_at(std::uint64_t line, std::string_view file);
  /// Why the text cannot be split: a comment without an end. Empty if it can.
  [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
  void skip_blanks();
  void skip_comment();

  std::string_view rest_;
  std::string file_;  ///< empty for the scene file itself
  std::uint64_t line_ = 1;
  std::uint64_t word_line_ = 1;
  std::string_view peeked_;
  bool has_peeked_ = false;
  std::string fault_;
};

}  // namespace camway::scene::unigrafix
