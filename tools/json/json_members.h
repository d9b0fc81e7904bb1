// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "daemon/base/named_enum.h"
#include "daemon/collision/obstacles.h"
#include "daemon/planning/request/request.h"
#include "tools/json/json_angle.h"
#include "tools/json/json_document.h"
#include "tools/json/json_options.h"
#include "tools/json/json_path.h"

/// Structs as JSON objects. For a struct there is one list of members: a function
/// `members(io, value)` that calls `io.need(name, member)` or `io.may(name, member)` for each. It
/// serves both directions: `io` is a `JsonWriter` or a `JsonReader`.
namespace camway::tools {

template <class T, class Struct>
concept Is = std::same_as<std::remove_const_t<T>, Struct>;

/// An angle: in radians in memory, in degrees in files.
template <class Number>
struct Angle {
  Number& rad;
};
template <class Number>
Angle(Number&) -> Angle<Number>;

/// Two numbers of a struct that are one array in files.
template <class Number>
struct Both {
  Number& first;
  Number& second;
};
template <class Number>
Both(Number&, Number&) -> Both<Number>;

/// The index of a triangle, or a side of the bounds, which is a number below 0 in files.
template <class Number>
struct TriangleOrSide {
  Number& number;
};
template <class Number>
TriangleOrSide(Number&) -> TriangleOrSide<Number>;

/// The old name of a member, which is still read and no longer written.
struct Old {
  std::string_view name = {};
};

template <class Io, class Value>
concept HasMembers = requires(Io& io, Value& value) {
  members(io, value);
};

/// Writes an object. Each small object (a keyframe, an interval) is on one line, so that a person
/// can read a long path and `diff` can compare two.
class JsonWriter {
 public:
  explicit JsonWriter(std::string& out) : out_(out) {}

  /// Writes the whole object, whose members `write` writes. Each member is on a line of its own
  /// that begins with `indent` spaces; if `indent` is below 0, all are on one line.
  template <class Write>
  void object(int indent, const Write& write) {
    const int outer = std::exchange(indent_, indent);
    out_ += '{';
    is_first_ = true;
    write();
    if (indent_ >= 0) new_line(indent_ - 2);
    out_ += '}';
    is_first_ = false;
    indent_ = outer;
  }

  /// Begins a line with `indent` spaces for the next member.
  void line(int indent) { line_ = indent; }

  /// Writes a member that readers require.
  template <class Value>
  void need(std::string_view name, const Value& member, Old = {}) {
    begin(name);
    value(member);
    path_.pop_back();
  }
  /// Writes an optional member, which is left out if `is_said` is false.
  template <class Value>
  void may(std::string_view name, const Value& member, bool is_said = true) {
    if (is_said) need(name, member);
    line_ = -1;
  }
  template <class Value>
  void may(std::string_view name, const std::optional<Value>& member) {
    if (member) need(name, *member);
    line_ = -1;
  }
  /// Writes an optional object whose members `each` lists.
  template <class Each>
  void group(std::string_view name, bool is_said, int indent, const Each& each) {
    line_ = is_said ? line_ : -1;
    if (!is_said) return;
    begin(name);
    object(indent, [&] { each(*this); });
    path_.pop_back();
  }

  /// Returns the first member that could not be written, and why: "keyframes[].position: is not
  /// finite". Empty if there is none.
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  void new_line(int indent) { out_.append("\n").append(static_cast<std::size_t>(indent), ' '); }
  void begin(std::string_view name);
  void number(double number);

  void value(double number) { this->number(number); }
  void value(bool flag) { out_ += flag ? "true" : "false"; }
  void value(std::integral auto number) { out_ += std::to_string(number); }
  void value(std::string_view text);
  void value(const std::string& text) { value(std::string_view(text)); }
  template <base::NamedEnum Enum>
  void value(Enum named) {
    value(base::name_of(named));
  }
  template <class Number>
  void value(const Angle<Number>& angle) {
    number(degrees(angle.rad));
  }
  template <class Number>
  void value(const Both<Number>& both) {
    array(std::array{both.first, both.second});
  }
  template <class Number>
  void value(const TriangleOrSide<Number>& triangle) {
    value(collision::Obstacles::signed_number(triangle.number));
  }
  template <int kSize>
  void value(const Eigen::Matrix<double, kSize, 1>& vector) {
    array(vector);
  }
  void value(const geometry::Quat& orientation) { array(geometry::wxyz(orientation)); }
  /// Writes null for a side without a limit.
  void value(const geometry::Bounds& bounds);
  template <class Vector, std::size_t kCount>
  void value(const std::array<Vector, kCount>& points) {
    array(points);
  }
  void value(const std::vector<std::uint32_t>& numbers) { array(numbers); }
  /// Writes an array with one element on each line.
  template <class Value>
  void value(const std::vector<Value>& list) {
    value(std::span<const Value>(list));
  }
  template <class Value>
  void value(std::span<const Value> list) {
    path_.emplace_back("[]");
    out_ += '[';
    bool first = true;
    for (const Value& element : list) {
      out_ += std::exchange(first, false) ? "\n    " : ",\n    ";
      value(element);
    }
    out_ += first ? "]" : "\n  ]";
    path_.pop_back();
  }
  template <class Value>
  requires HasMembers<JsonWriter, const Value>
  void value(const Value& object) {
    this->object(-1, [&] { members(*this, object); });
  }

  template <class List>
  void array(const List& list) {
    const char* separator = "[";
    for (const auto& element : list) {
      out_ += std::exchange(separator, ", ");
      value(element);
    }
    out_ += list.size() == 0 ? "[]" : "]";
  }

  std::string& out_;
  std::string error_;
  std::vector<std::string_view> path_;  ///< names that lead to the value that is being written
  int indent_ = -1;
  int line_ = -1;
  bool is_first_ = true;
};

/// Reads an object. Ignores members that are not in the list.
class JsonReader {
 public:
  explicit JsonReader(const Field& object) : object_(object) {}

  void line(int) {}
  template <class Value>
  void need(std::string_view name, Value&& member, Old old = {}) {
    value(object_.member(name, old.name), member);
  }
  template <class Value>
  void may(std::string_view name, Value&& member, bool = true) {
    if (const auto field = object_.optional_member(name)) value(*field, member);
  }
  template <class Each>
  void group(std::string_view name, bool, int, const Each& each) {
    if (const auto field = object_.optional_member(name)) {
      JsonReader group(*field);
      each(group);
    }
  }

 private:
  void value(const Field& field, double& number) { number = field.number(); }
  void value(const Field& field, bool& flag) { flag = field.boolean(); }
  void value(const Field& field, std::string& text) { text = field.text(); }
  void value(const Field& field, std::int32_t& count) {
    count = static_cast<std::int32_t>(field.integer(0, std::numeric_limits<std::int32_t>::max()));
  }
  void value(const Field& field, std::uint32_t& index) {
    index = static_cast<std::uint32_t>(field.integer(0, std::numeric_limits<std::uint32_t>::max()));
  }
  /// Reads the index of a keyframe.
  void value(const Field& field, std::size_t& index) {
    index = static_cast<std::size_t>(field.integer(0, planning::kMaxKeyframes));
  }
  template <base::NamedEnum Enum>
  void value(const Field& field, Enum& named) {
    const std::string name = field.text();
    const std::optional<Enum> found = base::value_of<Enum>(name);
    if (!found) field.fail("'" + name + "' is unknown");
    named = found.value_or(named);
  }
  void value(const Field& field, motion::KeyframeOrigin& origin) { origin = read_origin(field); }
  void value(const Field& field, Angle<double>& angle) { angle.rad = radians(field.number()); }
  void value(const Field& field, Both<double>& both) {
    double numbers[2] = {};
    field.numbers(numbers, 2);
    both.first = numbers[0];
    both.second = numbers[1];
  }
  void value(const Field& field, TriangleOrSide<std::uint32_t>& triangle) {
    constexpr auto kSides = static_cast<std::int64_t>(geometry::Bounds::kSides);
    triangle.number = static_cast<std::uint32_t>(
        field.integer(-kSides, std::numeric_limits<std::uint32_t>::max()));
  }
  template <int kSize>
  void value(const Field& field, Eigen::Matrix<double, kSize, 1>& vector) {
    field.numbers(vector.data(), kSize);
  }
  void value(const Field& field, geometry::Quat& orientation) {
    geometry::Vec4 wxyz;
    value(field, wxyz);
    orientation = geometry::from_wxyz(wxyz);
  }
  void value(const Field& field, geometry::Bounds& bounds) { bounds = read_bounds(field); }
  template <class Value>
  void value(const Field& field, std::optional<Value>& member) {
    value(field, member.emplace());
  }
  template <class Value>
  void value(const Field& field, std::vector<Value>& list) {
    const std::size_t count = field.size();
    for (std::size_t i = 0; i < count && !field.failed(); ++i) {
      value(field.element(i), list.emplace_back());
    }
  }
  template <class Value>
  requires HasMembers<JsonReader, Value>
  void value(const Field& field, Value& object) {
    JsonReader reader(field);
    members(reader, object);
  }

  const Field& object_;
};

}  // namespace camway::tools
