// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>
#include <camway_python/described.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "client/python/module/faults.h"

/// Converts between the structs of the C++ client and Python's data classes, which have the same
/// members (`generate_types.py`). Lists of points are arrays of NumPy. All functions need the GIL.
namespace camway::python {

namespace py = pybind11;

template <class T>
concept IsDescribed = requires {
  Described<T>::kName;
};
template <class T>
concept IsLazy = IsDescribed<T> && Described<T>::kIsLazy;
template <class T>
concept IsNamed = requires {
  Names<T>::kValues;
};

/// A struct that has numbers alone, lists of which are arrays with a column for each number.
template <class T>
inline constexpr std::size_t kColumns = 0;
template <>
inline constexpr std::size_t kColumns<OccupancyBox> = 6;
template <>
inline constexpr std::size_t kColumns<OccupancySphere> = 4;
template <>
inline constexpr std::size_t kColumns<OccupancyRay> = 7;
template <>
inline constexpr std::size_t kColumns<OccupancyDistance> = 4;
template <>
inline constexpr std::size_t kColumns<OccupancySpherePath> = 7;
template <class Number, std::size_t kLength>
inline constexpr std::size_t kColumns<std::array<Number, kLength>> = kLength;

/// The number that a row has; void for other types.
template <class T>
struct NumberOf {
  using Type = double;
};
template <class Number, std::size_t kLength>
struct NumberOf<std::array<Number, kLength>> {
  using Type = Number;
};
template <class T>
concept IsRow = kColumns<T> >
0 && std::is_arithmetic_v<typename NumberOf<T>::Type>;

template <class T>
struct ElementOf {
  using Type = void;
};
template <class T>
struct ElementOf<std::vector<T>> {
  using Type = T;
};
template <class T, std::size_t kLength>
struct ElementOf<std::array<T, kLength>> {
  using Type = T;
};
template <class T>
using Element = typename ElementOf<T>::Type;
template <class T>
concept IsVector = std::same_as<T, std::vector<Element<T>>>;
template <class T>
concept IsArray = !std::is_void_v<Element<T>> && !IsVector<T>;

/// The class of a struct, and the names of its members. Set once, when the module is loaded, and
/// never destroyed: other modules may end later.
struct ClassOf {
  PyObject* type = nullptr;
  PyObject* names = nullptr;  ///< a tuple
};
template <IsDescribed T>
ClassOf& class_of() {
  static ClassOf loaded;
  return loaded;
}

/// Looks up the classes in the module `camway._types`.
void load_classes(const py::module_& types);

[[noreturn]] inline void refuse_type(const std::string& reason) {
  throw ConversionFault(ConversionFault::Kind::kType, reason);
}
[[noreturn]] inline void refuse_value(const std::string& reason) {
  throw ConversionFault(ConversionFault::Kind::kValue, reason);
}

/// Clears the exception that C functions of Python have set, for a text of our own.
inline void forget_error() { PyErr_Clear(); }

inline std::string type_name(py::handle value) { return Py_TYPE(value.ptr())->tp_name; }

inline double number_of(py::handle value) {
  const double number = PyFloat_AsDouble(value.ptr());
  if (number == -1.0 && PyErr_Occurred() != nullptr) {
    forget_error();
    refuse_type("must be a number, not " + type_name(value));
  }
  return number;
}

inline std::string utf8_of(py::handle value) {
  if (!PyUnicode_Check(value.ptr())) refuse_type("must be a text, not " + type_name(value));
  Py_ssize_t size = 0;
  const char* const bytes = PyUnicode_AsUTF8AndSize(value.ptr(), &size);
  if (bytes == nullptr) {
    forget_error();
    refuse_value("has a surrogate, which is no character");
  }
  return {bytes, static_cast<std::size_t>(size)};
}

template <std::integral Number>
Number integer_of(py::handle value) {
  const py::object index = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
  if (!index) {
    forget_error();
    refuse_type("must be a whole number, not " + type_name(value));
  }
  int overflow = 0;
  const long long number = PyLong_AsLongLongAndOverflow(index.ptr(), &overflow);
  if (overflow != 0 || !std::in_range<Number>(number)) refuse_value("is beyond the range");
  return static_cast<Number>(number);
}

/// Whether an array holds real numbers, or nothing at all.
inline bool has_numbers(const py::array& array) {
  const char kind = array.dtype().kind();
  return kind == 'f' || kind == 'i' || kind == 'u' || array.size() == 0;
}

/// Returns an array of numbers with `kWidth` columns; an empty list has any number of them.
template <class Number>
py::array_t<Number> rows_of(py::handle value, std::size_t width) {
  using Array = py::array_t<Number, py::array::c_style | py::array::forcecast>;
  const std::string shape = "must be an array of rows of " + std::to_string(width) + " numbers";
  const py::array any = py::array::ensure(value);
  // An array of floats as indices would be cut to whole numbers.
  const bool is_number = any && has_numbers(any);
  const bool is_whole =
      any && (std::floating_point<Number> || any.dtype().kind() != 'f' || any.size() == 0);
  if (!is_number || !is_whole) {
    forget_error();
    refuse_type(std::is_integral_v<Number> ? shape + ", all whole" : shape);
  }
  Array rows = Array::ensure(any);
  if (!rows) {
    forget_error();
    refuse_type(shape);
  }
  if (rows.size() == 0) return rows;
  const auto columns = rows.ndim() < 2 ? py::ssize_t{0} : rows.size() / rows.shape(0);
  if (columns != static_cast<py::ssize_t>(width)) refuse_value(shape);
  return rows;
}

template <class T>
void from_python(py::handle value, T& mine);
template <class T>
py::object to_python(const T& mine);
/// Converts a struct whose members are converted when they are first asked for (`lazy.h`).
template <IsDescribed T>
py::object lazy_to_python(T value);

/// Converts the items of a list, a tuple or another sequence.
template <class Take>
void for_each_item(py::handle value, const Take& take) {
  const bool is_text = PyUnicode_Check(value.ptr()) || PyBytes_Check(value.ptr());
  const py::object items =
      py::reinterpret_steal<py::object>(is_text ? nullptr : PySequence_Fast(value.ptr(), ""));
  if (!items) {
    forget_error();
    refuse_type("must be a list, not " + type_name(value));
  }
  const py::ssize_t count = PySequence_Fast_GET_SIZE(items.ptr());
  for (py::ssize_t i = 0; i < count; ++i) {
    try {
      take(static_cast<std::size_t>(i), py::handle(PySequence_Fast_GET_ITEM(items.ptr(), i)));
    } catch (const ConversionFault& fault) {
      throw fault.within("[" + std::to_string(i) + "]");
    }
  }
}

template <IsArray T>
void array_from_python(py::handle value, T& mine) {
  std::size_t count = 0;
  for_each_item(value, [&](std::size_t i, py::handle item) {
    if (i < mine.size()) from_python(item, mine[i]);
    count = i + 1;
  });
  if (count != mine.size()) {
    refuse_value("must be " + std::to_string(mine.size()) + " numbers, not " +
                 std::to_string(count));
  }
}

template <IsVector T>
void vector_from_python(py::handle value, T& mine) {
  using Item = Element<T>;
  if constexpr (std::same_as<Item, std::uint8_t>) {
    const py::object bytes = py::reinterpret_steal<py::object>(PyBytes_FromObject(value.ptr()));
    if (!bytes || PyUnicode_Check(value.ptr())) {
      forget_error();
      refuse_type("must be bytes, not " + type_name(value));
    }
    const char* begin = PyBytes_AS_STRING(bytes.ptr());
    mine.assign(begin, begin + PyBytes_GET_SIZE(bytes.ptr()));
  } else if constexpr (IsRow<Item>) {
    const auto rows = rows_of<typename NumberOf<Item>::Type>(value, kColumns<Item>);
    static_assert(sizeof(Item) == kColumns<Item> * sizeof(typename NumberOf<Item>::Type));
    static_assert(std::is_trivially_copyable_v<Item>);
    mine.resize(static_cast<std::size_t>(rows.size()) / kColumns<Item>);
    if (!mine.empty())
      std::memcpy(static_cast<void*>(mine.data()), rows.data(), mine.size() * sizeof(Item));
  } else {
    mine.clear();
    for_each_item(value, [&](std::size_t, py::handle item) {
      if constexpr (std::same_as<Item, bool>) {
        bool element = false;
        from_python(item, element);
        mine.push_back(element);
      } else {
        from_python(item, mine.emplace_back());
      }
    });
  }
}

/// Reads the members of an object of the struct's class.
template <IsDescribed T>
void struct_from_python(py::handle value, T& mine) {
  const ClassOf& known = class_of<T>();
  if (PyObject_IsInstance(value.ptr(), known.type) != 1) {
    refuse_type(std::string("must be a camway.") + Described<T>::kName + ", not " +
                type_name(value));
  }
  Described<T>::visit_members(
      [&](std::size_t i, auto& member) {
        const auto position = static_cast<py::ssize_t>(i);
        const py::object attribute = py::reinterpret_steal<py::object>(
            PyObject_GetAttr(value.ptr(), PyTuple_GET_ITEM(known.names, position)));
        if (!attribute) throw py::error_already_set();
        try {
          from_python(attribute, member);
        } catch (const ConversionFault& fault) {
          throw fault.within(Described<T>::kMembers[i]);
        }
      },
      mine);
}

template <class... Alternatives>
void variant_from_python(py::handle value, std::variant<Alternatives...>& mine) {
  const auto take = [&]<class T>(T alternative) {
    if (PyObject_IsInstance(value.ptr(), class_of<T>().type) != 1) return false;
    struct_from_python(value, alternative);
    mine = std::move(alternative);
    return true;
  };
  if (!(take(Alternatives{}) || ...)) refuse_type("is no shape: " + type_name(value));
}

template <IsNamed T>
void name_from_python(py::handle value, T& mine) {
  if (!PyUnicode_Check(value.ptr())) {
    refuse_type("must be a name, not " + type_name(value));
  }
  const std::string text = utf8_of(value);
  std::string known;
  for (const auto& [number, name] : Names<T>::kValues) {
    if (text == name) {
      mine = number;
      return;
    }
    known += (known.empty() ? "" : ", ") + std::string(name);
  }
  refuse_value("'" + text + "' is unknown; the values are " + known);
}

template <class T>
void from_python(py::handle value, T& mine) {
  if constexpr (std::same_as<T, bool>) {
    const int truth = PyNumber_Check(value.ptr()) ? PyObject_IsTrue(value.ptr()) : -1;
    if (truth < 0) {
      forget_error();
      refuse_type("must be True or False, not " + type_name(value));
    }
    mine = truth == 1;
  } else if constexpr (std::floating_point<T>) {
    mine = number_of(value);
  } else if constexpr (std::integral<T>) {
    mine = integer_of<T>(value);
  } else if constexpr (std::same_as<T, std::string>) {
    mine = utf8_of(value);
  } else if constexpr (requires { mine.has_value(); }) {
    if (value.is_none()) {
      mine.reset();
    } else {
      from_python(value, mine.emplace());
    }
  } else if constexpr (IsNamed<T>) {
    name_from_python(value, mine);
  } else if constexpr (std::same_as<T, Path>) {
    if (!py::isinstance<Path>(value)) refuse_type("must be a camway.Path, not " + type_name(value));
    mine = value.cast<const Path&>();
  } else if constexpr (IsDescribed<T>) {
    struct_from_python(value, mine);
  } else if constexpr (IsVector<T>) {
    vector_from_python(value, mine);
  } else if constexpr (IsArray<T>) {
    array_from_python(value, mine);
  } else {
    variant_from_python(value, mine);
  }
}

/// Returns an argument of a function as a struct.
template <class T>
T argument(py::handle value, const std::string& name) {
  T mine{};
  try {
    from_python(value, mine);
  } catch (const ConversionFault& fault) {
    // Members name themselves; a fault of the whole argument has no name yet.
    throw fault.names_member() ? fault : fault.within(name);
  }
  return mine;
}

/// Makes an array of numbers with a copy of the data.
template <class Number, class Stored>
py::object array_of(const Stored* numbers, std::vector<py::ssize_t> shape) {
  py::array_t<Number> array(std::move(shape));
  std::copy_n(numbers, array.size(), array.mutable_data());
  return array;
}

template <IsVector T>
py::object vector_to_python(const T& mine) {
  using Item = Element<T>;
  const auto count = static_cast<py::ssize_t>(mine.size());
  if constexpr (std::same_as<Item, std::uint8_t>) {
    return py::bytes(reinterpret_cast<const char*>(mine.data()), mine.size());
  } else if constexpr (std::same_as<Item, bool>) {
    py::array_t<bool> array(count);
    std::copy(mine.begin(), mine.end(), array.mutable_data());
    return array;
  } else if constexpr (std::same_as<Item, std::optional<double>>) {
    // No hit within range is one at an infinite distance.
    py::array_t<double> array(count);
    double* out = array.mutable_data();
    for (const auto& number : mine) {
      *out++ = number.value_or(std::numeric_limits<double>::infinity());
    }
    return array;
  } else if constexpr (std::integral<Item>) {
    return array_of<std::int64_t>(mine.data(), {count});
  } else if constexpr (IsRow<Item>) {
    using Number = typename NumberOf<Item>::Type;
    using Stored = std::conditional_t<std::floating_point<Number>, double, std::int64_t>;
    const Number* numbers = mine.empty() ? nullptr : mine.front().data();
    return array_of<Stored>(numbers, {count, static_cast<py::ssize_t>(kColumns<Item>)});
  } else {
    py::list list(mine.size());
    for (std::size_t i = 0; i < mine.size(); ++i) {
      PyList_SET_ITEM(list.ptr(), static_cast<py::ssize_t>(i), to_python(mine[i]).release().ptr());
    }
    return list;
  }
}

template <IsArray T>
py::object array_to_python(const T& mine) {
  if constexpr (IsArray<Element<T>>) {
    const auto columns = static_cast<py::ssize_t>(mine.front().size());
    return array_of<double>(mine.front().data(), {static_cast<py::ssize_t>(mine.size()), columns});
  } else {
    py::tuple tuple(mine.size());
    for (std::size_t i = 0; i < mine.size(); ++i) {
      PyTuple_SET_ITEM(tuple.ptr(), static_cast<py::ssize_t>(i),
                       to_python(mine[i]).release().ptr());
    }
    return tuple;
  }
}

/// Makes an object of the struct's class, whose members are its arguments in order.
template <IsDescribed T>
py::object struct_to_python(const T& mine) {
  std::array<py::object, Described<T>::kMembers.size()> members;
  std::array<PyObject*, Described<T>::kMembers.size()> arguments{};
  Described<T>::visit_members(
      [&](std::size_t i, const auto& member) {
        members[i] = to_python(member);
        arguments[i] = members[i].ptr();
      },
      mine);
  PyObject* made =
      PyObject_Vectorcall(class_of<T>().type, arguments.data(), arguments.size(), nullptr);
  if (made == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(made);
}

template <class T>
py::object to_python(const T& mine) {
  if constexpr (std::same_as<T, bool>) {
    return py::bool_(mine);
  } else if constexpr (std::floating_point<T>) {
    return py::float_(mine);
  } else if constexpr (std::integral<T>) {
    return py::int_(mine);
  } else if constexpr (std::same_as<T, std::string>) {
    // A text of the daemon may be cut within a character.
    return py::reinterpret_steal<py::object>(
        PyUnicode_DecodeUTF8(mine.data(), static_cast<py::ssize_t>(mine.size()), "replace"));
  } else if constexpr (requires { mine.has_value(); }) {
    return mine ? to_python(*mine) : py::none();
  } else if constexpr (IsNamed<T>) {
    for (const auto& [number, name] : Names<T>::kValues) {
      if (number == mine) return py::str(name);
    }
    return py::str("unknown");
  } else if constexpr (std::same_as<T, Path>) {
    return py::cast(mine);
  } else if constexpr (IsLazy<T>) {
    return lazy_to_python(mine);
  } else if constexpr (IsDescribed<T>) {
    return struct_to_python(mine);
  } else if constexpr (IsVector<T>) {
    return vector_to_python(mine);
  } else {
    return array_to_python(mine);
  }
}

}  // namespace camway::python
