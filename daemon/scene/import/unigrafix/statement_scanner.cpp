// SPDX-License-Identifier: MIT
#include "daemon/scene/import/unigrafix/statement_scanner.h"

#include <algorithm>
#include <cstddef>

#include "daemon/scene/import/readers/tokens.h"

namespace camway::scene::unigrafix {
namespace {

bool is_mark(char c) { return c == '(' || c == ')' || c == ';'; }

}  // namespace

void StatementScanner::skip_comment() {
  const std::uint64_t begin = line_;
  std::size_t depth = 0;
  for (std::size_t at = 0; at < rest_.size(); ++at) {
    if (rest_[at] == '\n') ++line_;
    if (rest_[at] == '{') ++depth;
    if (rest_[at] == '}' && --depth == 0) return rest_.remove_prefix(at + 1);
  }
  rest_ = {};
  word_line_ = begin;
  fault_ = place() + ": a comment has no end";
}

void StatementScanner::skip_blanks() {
  while (!rest_.empty()) {
    if (rest_.front() == '{') {
      skip_comment();
    } else if (mesh_readers::is_blank(rest_.front())) {
      if (rest_.front() == '\n') ++line_;
      rest_.remove_prefix(1);
    } else {
      return;
    }
  }
}

std::string_view StatementScanner::peek() {
  if (has_peeked_) return peeked_;
  skip_blanks();
  if (fault_.empty()) word_line_ = line_;
  std::size_t size = rest_.empty() ? 0 : 1;
  if (size > 0 && !is_mark(rest_.front())) {
    while (size < rest_.size() && !is_mark(rest_[size]) && rest_[size] != '{' &&
           !mesh_readers::is_blank(rest_[size])) {
      ++size;
    }
  }
  peeked_ = rest_.substr(0, size);
  rest_.remove_prefix(size);
  has_peeked_ = true;
  return peeked_;
}

std::string_view StatementScanner::next() {
  const std::string_view word = peek();
  has_peeked_ = false;
  return word;
}

std::string_view StatementScanner::rest_of_line() {
  const std::size_t size = std::min(rest_.find('\n'), rest_.size());
  const std::string_view line = rest_.substr(0, size);
  rest_.remove_prefix(size);
  return line;
}

std::string StatementScanner::place() const {
  return (file_.empty() ? "" : file_ + ", ") + "line " + std::to_string(word_line_);
}

void StatementScanner::continue_at(std::uint64_t line, std::string_view file) {
  // The end of this line is still to come.
  line_ = line == 0 ? 0 : line - 1;
  if (!file.empty()) file_ = file;
}

}  // namespace camway::scene::unigrafix
