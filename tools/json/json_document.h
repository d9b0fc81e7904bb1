// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace camway::tools {

/// What a document may cost before it is refused. A request with as many keyframes as planning
/// takes and the response to it stay below; a hostile document cannot make the reader take
/// gigabytes.
inline constexpr std::size_t kMaxDocumentBytes = std::size_t{256} << 20;
inline constexpr std::size_t kMaxDocumentValues = 16'000'000;
inline constexpr std::size_t kMaxDocumentDepth = 32;

/// Either a value or why there is none.
template <typename T>
struct Parsed {
  std::optional<T> value;
  std::string error;  ///< names the source and what is wrong in it; empty exactly with a value
};

/// Parses strict JSON. Refused beyond the syntax: documents past the limits above, numbers that
/// overflow a double, and a key that stands twice in one object (readers differ in which of the two
/// they take). `source` heads the error: `R.json: line 3, column 14: ...`. Lines and columns count
/// from 1, columns in bytes. Never throws for a bad document.
Parsed<nlohmann::json> parse_document(std::string_view text, std::string_view source);

/// Reads all of `file` ("-": standard input), at most kMaxDocumentBytes.
Parsed<std::string> read_text(const std::string& file);

/// A value inside a document that knows its path, for reading with messages such as
/// `keyframes[3].orientation: must be an array of 4 numbers`. The first error is kept, and after it
/// every read gives a default, so that callers check once at the end. Points to its parent and to
/// the error text: for local use only.
class Field {
 public:
  /// The document itself.
  Field(const nlohmann::json& root, std::string& error) : value_(&root), error_(&error) {}

  /// A member that must be there.
  [[nodiscard]] Field member(std::string_view key) const;
  /// A member that may be missing.
  [[nodiscard]] std::optional<Field> optional_member(std::string_view key) const;
  /// Element `index` of an array. Precondition: index < size().
  [[nodiscard]] Field element(std::size_t index) const;
  /// Length of an array; an error and 0 for anything else.
  [[nodiscard]] std::size_t size() const;

  [[nodiscard]] double number() const;
  [[nodiscard]] std::int64_t integer(std::int64_t least, std::int64_t largest) const;
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] bool is_null() const { return value_ != nullptr && value_->is_null(); }
  [[nodiscard]] std::string text() const;
  /// Reads exactly `count` numbers into `out`.
  void numbers(double* out, std::size_t count) const;

  /// The keys of an object in alphabetical order; an error for anything else.
  [[nodiscard]] std::vector<std::string> keys() const;

  /// An error for the first member whose key is none of `known`, so that a word that is spelled
  /// wrongly or that only a later version knows is not taken for a wish that was heeded. Keys that
  /// begin with '_' and the key "comment" are for the writer of the document alone, and pass.
  void allow_only(const std::vector<std::string_view>& known) const;

  /// Records an error about this value, unless there is one already.
  void fail(std::string_view message) const;
  [[nodiscard]] bool failed() const { return !error_->empty(); }
  /// `keyframes[3].orientation`; empty for the document.
  [[nodiscard]] std::string path() const;

 private:
  Field(const nlohmann::json* value, const Field* parent, std::string_view key, std::size_t index)
      : value_(value), parent_(parent), key_(key), index_(index), error_(parent->error_) {}

  const nlohmann::json* value_ = nullptr;  ///< null where the document has none
  const Field* parent_ = nullptr;
  std::string_view key_;  ///< empty for an element of an array
  std::size_t index_ = 0;
  std::string* error_;
};

/// Returns the value that the field's text names; else an error that lists the names, and the
/// first value.
template <typename Value, std::size_t kCount>
Value named(const Field& field,
            const std::array<std::pair<std::string_view, Value>, kCount>& names) {
  const std::string text = field.text();
  std::string list;
  for (const auto& [name, value] : names) {
    if (name == text) return value;
    list.append(list.empty() ? "" : ", ").append(name);
  }
  field.fail("'" + text + "' is unknown; there are " + list);
  return names.front().second;
}

/// Parses `text` and lets `read` make something of the document: the value, or the first error that
/// either met.
template <typename T>
Parsed<T> parse_as(T (*read)(const Field&), std::string_view text, std::string_view source) {
  const Parsed<nlohmann::json> document = parse_document(text, source);
  if (!document.value) return {{}, document.error};
  std::string error;
  T value = read(Field(*document.value, error));
  if (!error.empty()) return {{}, std::string(source) + ": " + error};
  return {std::move(value), {}};
}

/// The same of a file; "-" is standard input.
template <typename T>
Parsed<T> read_as(T (*read)(const Field&), const std::string& file) {
  const Parsed<std::string> text = read_text(file);
  if (!text.value) return {{}, text.error};
  return parse_as(read, *text.value, file == "-" ? "standard input" : file);
}

}  // namespace camway::tools
