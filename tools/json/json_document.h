// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/base/result.h"

namespace camway::tools {

/// Limits of a document, beyond which it is refused. The largest request and its response stay
/// below them; a hostile document cannot make the reader allocate gigabytes.
inline constexpr std::size_t kMaxDocumentBytes = std::size_t{256} << 20;
inline constexpr std::size_t kMaxDocumentValues = 16'000'000;
inline constexpr std::size_t kMaxDocumentDepth = 32;

/// Parses strict JSON. Also refuses documents beyond the limits above or of more than `most_values`
/// values, numbers that overflow a double, and a key that occurs twice in one object, because
/// readers differ in which one they take. `source` begins the error: `R.json: line 3, column 14:
/// ...`. Lines and columns count from 1, columns in bytes. Never throws for a bad document.
base::Result<nlohmann::json> parse_document(std::string_view text, std::string_view source,
                                            std::size_t most_values = kMaxDocumentValues);

/// Returns the name of a file in messages: "standard input" for "-".
std::string source_of(const std::string& file);

/// Reads the whole `file` ("-": standard input). Refuses more than kMaxDocumentBytes. The error
/// names the file.
base::Result<std::string> read_text(const std::string& file);

/// Findings in a document that is read.
struct DocumentNotes {
  std::string error;  ///< the first error; empty if there is none
  /// Members that the document has by their old names: the path with the old name, by the path.
  std::map<std::string, std::string, std::less<>> old_names;
};

/// A value of a document together with its path, for errors such as
/// `keyframes[3].orientation: must be an array of 4 numbers`. Only the first error is kept; after
/// it every read returns a default, so callers check once at the end. Holds pointers to its parent
/// and to the notes, which must outlive it.
class Field {
 public:
  /// The document itself.
  Field(const nlohmann::json& root, DocumentNotes& notes) : value_(&root), notes_(&notes) {}

  /// Returns a required member. If the object does not have `key`, returns the member `old`, the
  /// old name of that member. Records an error if the object has both.
  [[nodiscard]] Field member(std::string_view key, std::string_view old = {}) const;
  /// Returns an optional member as `member` does, or nothing if it is missing.
  [[nodiscard]] std::optional<Field> optional_member(std::string_view key,
                                                     std::string_view old = {}) const;
  /// Returns element `index` of an array. Requires index < size().
  [[nodiscard]] Field element(std::size_t index) const;
  /// Returns the length of an array; for any other value records an error and returns 0.
  [[nodiscard]] std::size_t size() const;

  [[nodiscard]] double number() const;
  [[nodiscard]] std::int64_t integer(std::int64_t least, std::int64_t largest) const;
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] bool is_null() const { return value_ != nullptr && value_->is_null(); }
  [[nodiscard]] std::string text() const;
  /// Returns a text of a remark: an empty one, and no error, if this is no object or has no such
  /// text.
  [[nodiscard]] std::string remark(std::string_view key) const;
  /// Reads exactly `count` numbers into `out`.
  void numbers(double* out, std::size_t count) const;

  /// Returns the keys of an object in alphabetical order; for any other value records an error.
  [[nodiscard]] std::vector<std::string> keys() const;

  /// Records an error for the first member whose key is neither in `known` nor in `old`: an option
  /// that is misspelled, or that only a later version knows, must not be ignored silently. Keys
  /// that begin with '_' and the key "comment" are remarks and pass. The error lists `known` alone.
  void allow_only(const std::vector<std::string_view>& known,
                  const std::vector<std::string_view>& old = {}) const;

  /// Records an error about this value, unless there is one already.
  void fail(std::string_view message) const;
  /// Records "is 7; it must ..." about this value, as `fail` does. Requires a number.
  void fail_number(std::string_view rule) const;
  [[nodiscard]] bool failed() const { return !notes_->error.empty(); }
  /// Returns the findings so far.
  [[nodiscard]] const DocumentNotes& notes() const { return *notes_; }
  /// Returns the path, such as `keyframes[3].orientation`; empty for the document.
  [[nodiscard]] std::string path() const;

 private:
  Field(const nlohmann::json* value, const Field* parent, std::string_view key, std::size_t index)
      : value_(value), parent_(parent), key_(key), index_(index), notes_(parent->notes_) {}

  const nlohmann::json* value_ = nullptr;  ///< null if the document has no such value
  const Field* parent_ = nullptr;
  std::string_view key_;  ///< empty for an element of an array
  std::size_t index_ = 0;
  DocumentNotes* notes_;
};

/// Returns the index of the name that the field's text is. For an unknown name, records an error
/// that lists all names and returns 0.
std::size_t named(const Field& field, std::span<const std::string_view> names);

/// Reads a `T` from a parsed document by `read_value(field, value)`. Returns the value, or the
/// first error, which begins with `source`.
template <typename T>
base::Result<T> read_document(const nlohmann::json& document, std::string_view source) {
  DocumentNotes notes;
  T value;
  read_value(Field(document, notes), value);
  if (!notes.error.empty()) return base::Failure{std::string(source) + ": " + notes.error};
  return value;
}

/// Parses `text` and reads a `T` from the document, as `read_document` does. Returns the value, or
/// the first error of either step. `source` begins the error, such as
/// `R.json: keyframes[3].orientation: has length zero`.
template <typename T>
base::Result<T> parse_as(std::string_view text, std::string_view source) {
  const base::Result<nlohmann::json> document = parse_document(text, source);
  if (!document) return base::Failure{document.error};
  return read_document<T>(*document, source);
}

/// Reads a file ("-": standard input) as `parse_as` does.
template <typename T>
base::Result<T> read_as(const std::string& file) {
  const base::Result<std::string> text = read_text(file);
  if (!text) return base::Failure{text.error};
  return parse_as<T>(*text, source_of(file));
}

}  // namespace camway::tools
