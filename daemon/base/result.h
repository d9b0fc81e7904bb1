// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>
#include <optional>
#include <string>
#include <utility>

namespace camway::base {

/// The reason why there is no value. Converts to a `Result` of any type.
struct Failure {
  std::string error;  ///< for the user [Limit: not empty]
};

/// The outcome of a function that may fail in expected ways, such as for a bad file: a value, or
/// the reason why there is none. A value and a `Failure` both convert to it. `*` and `->` require a
/// value.
template <typename T>
struct [[nodiscard]] Result {
  std::optional<T> value;
  std::string error;  ///< empty exactly if there is a value

  Result(T result) : value(std::move(result)) {}
  Result(Failure failure) : error(std::move(failure.error)) { assert(!error.empty()); }

  /// Returns whether there is a value.
  explicit operator bool() const { return value.has_value(); }

  [[nodiscard]] T& operator*() & { return *value; }
  [[nodiscard]] const T& operator*() const& { return *value; }
  [[nodiscard]] T&& operator*() && { return *std::move(value); }
  [[nodiscard]] T* operator->() { return &*value; }
  [[nodiscard]] const T* operator->() const { return &*value; }
};

}  // namespace camway::base
