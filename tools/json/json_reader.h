// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "daemon/base/named_enum.h"
#include "daemon/geometry/bounds.h"
#include "daemon/planning/request/field_spec.h"
#include "daemon/planning/result/members.h"
#include "tools/json/json_angle.h"
#include "tools/json/json_document.h"

/// Reads values and structs from JSON. `read_value(field, value)` reads a value of any type that
/// requests and answers have. It records an error in the document for a value of another form.
namespace camway::tools {

inline void read_value(const Field& field, double& number) { number = field.number(); }
inline void read_value(const Field& field, bool& flag) { flag = field.boolean(); }
inline void read_value(const Field& field, std::string& text) { text = field.text(); }
/// Reads a number that counts something.
void read_value(const Field& field, std::int32_t& count);
/// Reads the index of a triangle, or a side of the bounds, which is a number below 0.
void read_value(const Field& field, std::uint32_t& triangle_or_side);
/// Reads the index of a keyframe.
void read_value(const Field& field, std::size_t& keyframe);
/// Reads indices of triangles.
void read_value(const Field& field, std::vector<std::uint32_t>& triangles);
void read_value(const Field& field, std::tuple<double&, double&> both);
/// Reads numbers in the order w, x, y, z, as they are.
void read_value(const Field& field, geometry::Quat& orientation);
/// Reads `{"min": [...], "max": [...]}`. Either corner may be left out, and null is no limit.
void read_value(const Field& field, geometry::Bounds& bounds);

template <base::NamedEnum Enum>
void read_value(const Field& field, Enum& value) {
  value = named(field, base::named_values<Enum>());
}
template <int kSize>
void read_value(const Field& field, Eigen::Matrix<double, kSize, 1>& vector) {
  field.numbers(vector.data(), kSize);
}
template <class Vector, std::size_t kCount>
void read_value(const Field& list, std::array<Vector, kCount>& control_points) {
  const std::size_t count = list.size();
  if (!list.failed() && count != kCount) {
    list.fail("must hold " + std::to_string(kCount) + " control points, not " +
              std::to_string(count));
  }
  for (std::size_t i = 0; i < kCount && !list.failed(); ++i) {
    read_value(list.element(i), control_points[i]);
  }
}
template <class Value>
void read_value(const Field& field, std::optional<Value>& value) {
  read_value(field, value.emplace());
}
template <class Value>
void read_value(const Field& field, std::vector<Value>& list) {
  const std::size_t count = field.size();
  for (std::size_t i = 0; i < count && !field.failed(); ++i) {
    read_value(field.element(i), list.emplace_back());
  }
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

  void line(int) const {}
  template <class Value>
  void need(planning::FileName name, Value&& member) const {
    read(object_.member(name.name, name.old), name.name, member);
  }
  template <class Value>
  void may(planning::FileName name, bool, Value&& member) const {
    if (const auto field = object_.optional_member(name.name)) read(*field, name.name, member);
  }
  template <class List>
  void group(planning::FileName name, bool, int, const List& list) const {
    const auto field = object_.optional_member(name.name);
    if (!field) return;
    const JsonReader object(*field);
    list(object);
  }
  template <class Struct, class List>
  void optional(planning::FileName name, std::optional<Struct>& member, const List& list) const {
    const auto field = object_.optional_member(name.name);
    if (!field) return;
    const JsonReader object(*field);
    list(object, member.emplace());
  }

  /// Reads a member of a table if the object has it.
  template <class Value>
  void operator()(const planning::FieldSpec& spec, Value& member) const {
    const auto field = object_.optional_member(spec.file_name(), spec.old_file);
    if (field) read(*field, spec.file_name(), member);
  }
  /// Reads a whole number of any size, from the least of its range.
  void operator()(const planning::FieldSpec& spec, std::uint64_t& number) const {
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
    const auto field = object_.optional_member(spec.file_name(), spec.old_file);
    const auto least = static_cast<std::int64_t>(spec.range.least);
    if (field) number = static_cast<std::uint64_t>(field->integer(least, kMost));
  }

 private:
  template <class Value>
  static void read(const Field& field, std::string_view name, Value& member) {
    if constexpr (std::same_as<Value, double>) {
      member = planning::is_angle(name) ? radians(field.number()) : field.number();
    } else {
      read_value(field, member);
    }
  }

  const Field& object_;
};

/// Reads an object that has members of a table alone; any may be missing.
/// `visit_table(visit)` visits the table with the members that are read.
template <class VisitTable>
void read_table(const Field& field, const VisitTable& visit_table) {
  allow_only(field, {}, visit_table);
  visit_table(JsonReader(field));
}

template <class Struct>
requires requires(const JsonReader& io, Struct& value) { planning::members(io, value); }
void read_value(const Field& field, Struct& object) {
  const JsonReader reader(field);
  planning::members(reader, object);
}

}  // namespace camway::tools
