// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "daemon/base/named_enum.h"
#include "daemon/geometry/bounds.h"
#include "daemon/planning/request/field_spec.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/members.h"
#include "tools/json/json_angle.h"
#include "tools/json/json_document.h"

/// Reads values and structs from JSON. `read_value(field, value)` reads a value of any type that
/// requests and answers have. It records an error in the document for a value of another form.
namespace camway::tools {

inline constexpr std::int64_t kMaxIndex = std::numeric_limits<std::uint32_t>::max();

template <std::integral Number>
void read_integer(const Field& field, std::int64_t least, std::int64_t most, Number& number) {
  number = static_cast<Number>(field.integer(least, most));
}
/// Reads a number that counts something.
inline void read_value(const Field& field, std::int32_t& count) {
  read_integer(field, 0, std::numeric_limits<std::int32_t>::max(), count);
}
/// Reads the index of a triangle, or a side of the bounds, which is a number below 0.
inline void read_value(const Field& field, std::uint32_t& triangle_or_side) {
  read_integer(field, -std::int64_t{geometry::Bounds::kSides}, kMaxIndex, triangle_or_side);
}
/// Reads the index of a keyframe.
inline void read_value(const Field& field, std::size_t& keyframe) {
  read_integer(field, 0, planning::kMaxKeyframes, keyframe);
}
inline void read_value(const Field& field, std::tuple<double&, double&> both) {
  double numbers[2] = {};
  field.numbers(numbers, 2);
  both = std::tuple(numbers[0], numbers[1]);
}

/// Reads an array of any length, or of that of `elements`, each element by `read(field, element)`.
template <class List, class Read>
void read_list(const Field& field, List& elements, const Read& read) {
  constexpr bool kGrows = requires { elements.emplace_back(); };
  const std::size_t count = field.size();
  if (!kGrows && !field.failed() && count != elements.size()) {
    field.fail("must be an array of " + std::to_string(elements.size()) + ", not of " +
               std::to_string(count));
  }
  for (std::size_t i = 0; i < count && !field.failed(); ++i) {
    if constexpr (kGrows) elements.emplace_back();
    read(field.element(i), elements[i]);
  }
}

/// Reads `{"min": [...], "max": [...]}`. Either corner may be left out, and null is no limit.
inline void read_value(const Field& field, geometry::Bounds& bounds) {
  field.allow_only({"min", "max"});
  bounds = {};
  const auto read_corner = [&](std::string_view name, geometry::Vec3& corner_W) {
    const auto read = [](const Field& item, double& limit_m) {
      if (!item.is_null()) limit_m = item.number();
    };
    std::span<double, 3> limits_m(corner_W.data(), 3);
    if (const auto corner = field.optional_member(name)) read_list(*corner, limits_m, read);
  };
  read_corner("min", bounds.min_W);
  read_corner("max", bounds.max_W);
}

/// Records an error for the first member that is neither in `names` nor in a table of members
/// (`planning/request/options.h`). `visit_table(visit)` visits the table.
template <class VisitTable>
void allow_only(const Field& field, std::vector<std::string_view> names,
                const VisitTable& visit_table) {
  std::vector<std::string_view> old_names;
  visit_table([&](const planning::FieldSpec& spec, const auto&...) {
    names.push_back(spec.file_name());
    if (!spec.old_file.empty()) old_names.push_back(spec.old_file);
  });
  field.allow_only(names, old_names);
}

/// Reads the members of an object that are in a list (`planning/result/members.h`) or a table
/// (`planning/request/options.h`). Ignores other members.
class JsonReader {
 public:
  explicit JsonReader(const Field& object) : object_(object) {}

  template <class Value>
  void operator()(planning::FileName name, Value&& member) const {
    if (name.is_needed) return read(object_.member(name.name, name.old), name.name, member);
    const auto field = object_.optional_member(name.name, name.old);
    if (field) read(*field, name.name, member);
  }
  template <class List>
  void group(planning::FileName name, int, const List& list) const {
    const auto field = object_.optional_member(name.name);
    if (!field) return;
    const JsonReader object(*field);
    list(object);
  }
  template <class Struct, class List>
  void optional(planning::FileName name, std::optional<Struct>& member, const List& list) const {
    group(name, 0, [&](const JsonReader& object) { list(object, member.emplace()); });
  }

  /// Reads a whole number of any size, from the least of its range.
  void operator()(const planning::FieldSpec& spec, std::uint64_t& number) const {
    const auto field = object_.optional_member(spec.file_name());
    const auto least = static_cast<std::int64_t>(spec.range.least);
    if (field) read_integer(*field, least, std::numeric_limits<std::int64_t>::max(), number);
  }

 protected:
  [[nodiscard]] const Field& object() const { return object_; }

 private:
  template <class Value>
  static void read(const Field& field, std::string_view name, Value& member) {
    read_value(field, member);
    if constexpr (std::same_as<Value, double>) {
      if (planning::is_angle(name)) member = radians(member);
    }
  }

  const Field& object_;
};

/// Reads an object that has members of a table alone. `visit_table(visit)` visits the table with
/// the members that are read.
template <class VisitTable>
void read_table(const Field& field, const VisitTable& visit_table) {
  allow_only(field, {}, visit_table);
  visit_table(JsonReader(field));
}

/// Reads a value of any other type: a number, a text, a name, a list, or a struct with a list of
/// members.
template <class Value>
void read_value(const Field& field, Value& value) {
  if constexpr (std::same_as<Value, double>) {
    value = field.number();
  } else if constexpr (std::same_as<Value, bool>) {
    value = field.boolean();
  } else if constexpr (std::same_as<Value, std::string>) {
    value = field.text();
  } else if constexpr (base::NamedEnum<Value>) {
    value = named(field, base::named_values<Value>());
  } else if constexpr (std::same_as<Value, geometry::Quat>) {
    geometry::Vec4 wxyz = geometry::Vec4::Zero();
    read_value(field, wxyz);
    value = geometry::from_wxyz(wxyz);  // of any length
  } else if constexpr (requires { Value::SizeAtCompileTime; }) {
    field.numbers(value.data(), Value::SizeAtCompileTime);
  } else if constexpr (requires { value.has_value(); }) {
    read_value(field, value.emplace());
  } else if constexpr (requires(const JsonReader& io) { planning::members(io, value); }) {
    const JsonReader io(field);
    planning::members(io, value);
  } else if constexpr (std::same_as<typename Value::value_type, std::uint32_t>) {
    const auto read = [](const Field& item, std::uint32_t& index) {
      read_integer(item, 0, kMaxIndex, index);
    };
    read_list(field, value, read);
  } else {
    read_list(field, value, [](const Field& item, auto& element) { read_value(item, element); });
  }
}

}  // namespace camway::tools
