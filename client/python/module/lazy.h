// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>

#include "client/python/module/convert.h"

/// Objects of Python that get a member when it is first asked for: an answer has hundreds of
/// numbers, of which most programs look at few. All functions need the GIL.
namespace camway::python {

/// A value of C++ from which an object of Python gets its members. Never changes.
class Source {
 public:
  Source() = default;
  virtual ~Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  /// Returns a new object for a member; none if `name`, a text, is of no member.
  [[nodiscard]] virtual py::object member(py::handle name) const = 0;
};

template <IsDescribed T>
class SourceOf final : public Source {
 public:
  explicit SourceOf(T value) : value_(std::move(value)) {}

  [[nodiscard]] py::object member(py::handle name) const override {
    py::object made;
    Described<T>::visit_members(
        [&](std::size_t i, const auto& member) {
          const auto position = static_cast<py::ssize_t>(i);
          PyObject* const known = PyTuple_GET_ITEM(class_of<T>().names, position);
          // Names in a program are the same object; others may be equal.
          if (known == name.ptr() || PyUnicode_Compare(known, name.ptr()) == 0) {
            made = to_python(member);
          }
        },
        value_);
    return made;
  }

 private:
  const T value_;
};

/// Makes an object without members of a class that is a `Lazy` in Python. They come from `source`.
py::object object_of(const ClassOf& known, std::unique_ptr<Source> source);

template <IsDescribed T>
py::object lazy_to_python(T value) {
  return object_of(class_of<T>(), std::make_unique<SourceOf<T>>(std::move(value)));
}

}  // namespace camway::python
