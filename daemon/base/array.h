// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace camway::base {

/// An array that does not change. It has its elements from a vector, or refers to memory that it
/// shares with others, such as a mapped file. Copies share the elements. Immutable. Thread-safe.
template <class T>
class Array {
 public:
  using value_type = T;

  Array() = default;
  /// Implicit, because a vector is an array.
  Array(std::vector<T> values) : Array(std::make_shared<const std::vector<T>>(std::move(values))) {}
  /// Refers to `values`, which live as long as `owner`.
  Array(std::shared_ptr<const void> owner, std::span<const T> values)
      : owner_(std::move(owner)), values_(values) {
    static_assert(std::is_trivially_copyable_v<T>);
  }

  [[nodiscard]] std::size_t size() const { return values_.size(); }
  [[nodiscard]] bool empty() const { return values_.empty(); }
  [[nodiscard]] const T* data() const { return values_.data(); }
  [[nodiscard]] auto begin() const { return values_.begin(); }
  [[nodiscard]] auto end() const { return values_.end(); }
  [[nodiscard]] const T& front() const { return values_.front(); }
  [[nodiscard]] const T& back() const { return values_.back(); }
  const T& operator[](std::size_t index) const { return values_[index]; }

  /// Whether both have equal elements.
  bool operator==(const Array& other) const {
    return std::equal(begin(), end(), other.begin(), other.end());
  }

 private:
  explicit Array(std::shared_ptr<const std::vector<T>> values) : owner_(values), values_(*values) {}

  std::shared_ptr<const void> owner_;
  std::span<const T> values_;
};

}  // namespace camway::base
