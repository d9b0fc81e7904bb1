// SPDX-License-Identifier: MIT
#include "tools/json/json_document.h"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <system_error>
#include <utility>
#include <vector>

namespace camway::tools {
namespace {

using nlohmann::json;

/// A place in a text. Writes to `end` the place up to which its copies have read.
class TextReader {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  TextReader(const char* at, const char*& end) : at_(at), end_(&end) {}
  reference operator*() const { return *at_; }
  TextReader& operator++() {
    *end_ = ++at_;
    return *this;
  }
  bool operator==(const TextReader& other) const { return at_ == other.at_; }

 private:
  const char* at_;
  const char** end_;
};

/// Receives the parser's events and builds the document. The library's own builder has no limits
/// and accepts an object with two equal keys.
class DocumentBuilder {
 public:
  /// `read_to` is the place up to which the parser has read the text that begins at `begin`.
  DocumentBuilder(json& root, const char* begin, const char* const& read_to,
                  std::size_t most_values)
      : root_(root), begin_(begin), read_to_(read_to), most_values_(most_values) {}

  bool null() { return add(nullptr); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(json::number_integer_t value) { return add(value); }
  bool number_unsigned(json::number_unsigned_t value) { return add(value); }
  bool number_float(json::number_float_t value, const std::string&) { return add(value); }
  bool string(std::string& value) { return add(std::move(value)); }
  bool binary(json::binary_t&) { return refuse("binary data is not JSON"); }

  bool start_object(std::size_t) { return open(json::object()); }
  bool end_object() { return close(); }
  bool start_array(std::size_t) { return open(json::array()); }
  bool end_array() { return close(); }

  bool key(std::string& name) {
    if (stack_.back()->contains(name)) return refuse("the key '" + name + "' stands twice");
    key_ = std::move(name);
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const json::exception& error) {
    position_ = position;
    reason_ = short_reason(error.what());
    return false;
  }

  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// Returns the number of bytes up to the end of what was refused. The parser reads one byte
  /// beyond a number.
  [[nodiscard]] std::size_t position() const { return position_; }

 private:
  bool refuse(std::string reason) {
    position_ = static_cast<std::size_t>(read_to_ - begin_);
    reason_ = std::move(reason);
    return false;
  }

  bool count_value() {
    return ++values_ <= most_values_ ||
           refuse("more than " + std::to_string(most_values_) + " values");
  }

  json* place(json value) {
    if (stack_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    json& parent = *stack_.back();
    if (parent.is_array()) {
      parent.push_back(std::move(value));
      return &parent.back();
    }
    return &(parent[key_] = std::move(value));
  }

  bool add(json value) {
    if (!count_value()) return false;
    place(std::move(value));
    return true;
  }

  bool open(json value) {
    if (stack_.size() == kMaxDocumentDepth) {
      return refuse("nested deeper than " + std::to_string(kMaxDocumentDepth) + " levels");
    }
    if (!count_value()) return false;
    stack_.push_back(place(std::move(value)));
    return true;
  }

  bool close() {
    stack_.pop_back();
    return true;
  }

  /// Removes "[json.exception.parse_error.101] parse error at line 3, column 2: " from the
  /// library's text. The place is added elsewhere, in one form for every kind of error.
  static std::string short_reason(std::string_view text) {
    if (const std::size_t bracket = text.find("] "); bracket != std::string_view::npos) {
      text.remove_prefix(bracket + 2);
    }
    if (text.starts_with("parse error")) {
      if (const std::size_t colon = text.find(": "); colon != std::string_view::npos) {
        text.remove_prefix(colon + 2);
      }
    }
    return std::string(text);
  }

  json& root_;
  const char* begin_;
  const char* const& read_to_;
  std::size_t most_values_;
  std::vector<json*> stack_;
  std::string key_;
  std::string reason_;
  std::size_t position_ = 0;
  std::size_t values_ = 0;
};

std::string line_and_column(std::string_view text, std::size_t bytes_read) {
  const std::string_view before = text.substr(0, std::min(bytes_read, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_start = before.rfind('\n');
  const std::size_t column =
      line_start == std::string_view::npos ? before.size() : before.size() - line_start - 1;
  return "line " + std::to_string(line) + ", column " +
         std::to_string(std::max<std::size_t>(column, 1));
}

const char* type_name(const json& value) {
  switch (value.type()) {
    case json::value_t::null:
      return "null";
    case json::value_t::object:
      return "an object";
    case json::value_t::array:
      return "an array";
    case json::value_t::string:
      return "a string";
    case json::value_t::boolean:
      return "a boolean";
    default:
      return "a number";
  }
}

}  // namespace

base::Result<json> parse_document(std::string_view text, std::string_view source,
                                  std::size_t most_values) {
  const std::string prefix = std::string(source) + ": ";
  if (text.size() > kMaxDocumentBytes) {
    return base::Failure{prefix + "larger than " + std::to_string(kMaxDocumentBytes >> 20) + " MB"};
  }
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    return base::Failure{prefix + "is empty"};
  }
  json root;
  const char* read_to = text.data();
  DocumentBuilder builder(root, text.data(), read_to, most_values);
  const TextReader begin(text.data(), read_to);
  const TextReader end(text.data() + text.size(), read_to);
  if (json::sax_parse(begin, end, &builder)) return root;
  return base::Failure{prefix + line_and_column(text, builder.position()) + ": " +
                       builder.reason()};
}

std::string source_of(const std::string& file) { return file == "-" ? "standard input" : file; }

base::Result<std::string> read_text(const std::string& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) return base::Failure{file + ": is a directory"};
  std::ifstream stream;
  const bool from_stdin = file == "-";
  if (!from_stdin) {
    errno = 0;
    stream.open(file, std::ios::binary);
    if (!stream) {
      return base::Failure{file + ": cannot be opened: " + std::generic_category().message(errno)};
    }
  }
  std::istream& input = from_stdin ? std::cin : stream;
  std::string text;
  std::vector<char> chunk(1 << 16);
  while (input.read(chunk.data(), static_cast<std::streamsize>(chunk.size())), input.gcount() > 0) {
    text.append(chunk.data(), static_cast<std::size_t>(input.gcount()));
    if (text.size() > kMaxDocumentBytes) {
      return base::Failure{source_of(file) + ": larger than " +
                           std::to_string(kMaxDocumentBytes >> 20) + " MB"};
    }
  }
  if (input.bad()) return base::Failure{source_of(file) + ": cannot be read"};
  return text;
}

Field Field::member(std::string_view key, std::string_view old) const {
  const std::optional<Field> found = optional_member(key, old);
  if (found) return *found;
  const Field missing(nullptr, this, key, 0);
  missing.fail("is missing");
  return missing;
}

std::optional<Field> Field::optional_member(std::string_view key, std::string_view old) const {
  if (failed()) return std::nullopt;
  if (!value_->is_object()) {
    fail(std::string("must be an object, not ") + type_name(*value_));
    return std::nullopt;
  }
  const auto found = value_->find(key);
  const auto found_old = old.empty() ? value_->end() : value_->find(old);
  if (found != value_->end() && found_old != value_->end()) {
    fail("has both " + std::string(key) + " and " + std::string(old) +
         ", its old name; leave one out");
    return std::nullopt;
  }
  if (found != value_->end()) return Field(&*found, this, key, 0);
  if (found_old == value_->end()) return std::nullopt;
  const Field by_old_name(&*found_old, this, old, 0);
  notes_->old_names.emplace(Field(nullptr, this, key, 0).path(), by_old_name.path());
  return by_old_name;
}

Field Field::element(std::size_t index) const { return {&(*value_)[index], this, {}, index}; }

std::size_t Field::size() const {
  if (failed()) return 0;
  if (value_->is_array()) return value_->size();
  fail(std::string("must be an array, not ") + type_name(*value_));
  return 0;
}

double Field::number() const {
  if (failed()) return 0.0;
  if (value_->is_number()) return value_->get<double>();
  fail(std::string("must be a number, not ") + type_name(*value_));
  return 0.0;
}

std::int64_t Field::integer(std::int64_t least, std::int64_t largest) const {
  if (failed()) return least;
  const std::string rule =
      "be a whole number from " + std::to_string(least) + " to " + std::to_string(largest);
  if (!value_->is_number()) {
    fail("must " + rule + ", not " + type_name(*value_));
    return least;
  }
  if (!value_->is_number_integer()) {
    fail_number(rule + ", without a decimal point or exponent");
    return least;
  }
  const bool too_large = value_->is_number_unsigned() &&
                         !std::in_range<std::int64_t>(value_->get<json::number_unsigned_t>());
  const std::int64_t value = too_large ? 0 : value_->get<std::int64_t>();
  if (!too_large && value >= least && value <= largest) return value;
  fail_number(rule);
  return least;
}

bool Field::boolean() const {
  if (failed()) return false;
  if (value_->is_boolean()) return value_->get<bool>();
  fail(std::string("must be true or false, not ") + type_name(*value_));
  return false;
}

std::string Field::text() const {
  if (failed()) return {};
  if (value_->is_string()) return value_->get<std::string>();
  fail(std::string("must be a string, not ") + type_name(*value_));
  return {};
}

std::string Field::remark(std::string_view key) const {
  if (failed() || !value_->is_object()) return {};
  const auto found = value_->find(key);
  return found != value_->end() && found->is_string() ? found->get<std::string>() : std::string();
}

void Field::numbers(double* out, std::size_t count) const {
  std::fill_n(out, count, 0.0);
  if (failed()) return;
  if (!value_->is_array() || value_->size() != count) {
    std::string actual = type_name(*value_);
    if (value_->is_array()) actual += " of " + std::to_string(value_->size());
    fail("must be an array of " + std::to_string(count) + " numbers, not " + actual);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) out[i] = element(i).number();
}

std::vector<std::string> Field::keys() const {
  if (failed()) return {};
  if (!value_->is_object()) {
    fail(std::string("must be an object, not ") + type_name(*value_));
    return {};
  }
  std::vector<std::string> keys;
  for (const auto& item : value_->items()) keys.push_back(item.key());
  return keys;
}

void Field::allow_only(const std::vector<std::string_view>& known,
                       const std::vector<std::string_view>& old) const {
  for (const std::string& key : keys()) {
    if (key == "comment" || key.starts_with('_')) continue;
    if (std::ranges::count(known, key) > 0 || std::ranges::count(old, key) > 0) continue;
    std::string list;
    for (const std::string_view word : known) list.append(list.empty() ? "" : ", ").append(word);
    member(key).fail("is unknown; " + (path().empty() ? "a request" : path()) + " has " + list +
                     ", and for remarks comment or _...");
    return;
  }
}

void Field::fail(std::string_view message) const {
  if (failed()) return;
  const std::string place = path();
  notes_->error = place.empty() ? std::string(message) : place + ": " + std::string(message);
}

void Field::fail_number(std::string_view rule) const {
  if (failed()) return;
  fail("is " + value_->dump() + "; it must " + std::string(rule));
}

std::string Field::path() const {
  if (parent_ == nullptr) return {};
  std::string path = parent_->path();
  if (key_.empty()) return path + "[" + std::to_string(index_) + "]";
  if (!path.empty()) path += '.';
  return path + std::string(key_);
}

std::size_t named(const Field& field, std::span<const std::string_view> names) {
  const std::string text = field.text();
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == text) return i;
    list.append(list.empty() ? "" : ", ").append(names[i]);
  }
  field.fail("'" + text + "' is unknown; there are " + list);
  return 0;
}

}  // namespace camway::tools
