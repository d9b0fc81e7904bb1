// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
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
#include "daemon/planning/request/option_table.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result_members.h"
#include "tools/json/json_angle.h"
#include "tools/json/json_document.h"

/// Reads values and structs from JSON. `read_value(field, value)` reads a value of any type that
/// requests and answers have. It records an error in the document for a value of another form.
namespace camway::tools {

template <std::integral Number>
void read_integer(const Field& field, std::int64_t least, Number& number) {
  constexpr std::uint64_t kLargest = std::numeric_limits<std::int64_t>::max();
  constexpr auto kMost = std::min<std::uint64_t>(std::numeric_limits<Number>::max(), kLargest);
  number = static_cast<Number>(field.integer(least, static_cast<std::int64_t>(kMost)));
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

/// Records an error for the first member that is neither in `names` nor in a table of members
/// (`planning/request/options.h`). `visit_table(visit)` visits the table.
template <class VisitTable>
void allow_only(const Field& field, std::vector<std::string_view> names,
                const VisitTable& visit_table) {
  std::vector<std::string_view> old_names;
  visit_table([&](planning::FileName name, const auto&) {
    names.push_back(name.name);
    if (!name.old.empty()) old_names.push_back(name.old);
  });
  field.allow_only(names, old_names);
}

/// Reads the members of an object that are in a list (`planning/result/result_members.h`) or a
/// table (`planning/request/options.h`). Ignores other members.
class JsonReader {
 public:
  explicit JsonReader(const Field& object) : object_(object) {}

  template <class Value>
  void operator()(planning::FileName name, Value&& member) const {
    const std::optional<Field> field = name.is_needed
                                           ? object_.member(name.name, name.old)
                                           : object_.optional_member(name.name, name.old);
    if (!field) return;
    read_value(*field, member);
    if constexpr (std::same_as<std::remove_cvref_t<Value>, double>) {
      if (planning::is_angle(name.name)) member = radians(member);
    }
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
    if (field) read_integer(*field, static_cast<std::int64_t>(spec.range.least), number);
  }

 protected:
  const Field& object_;
};

/// Reads a struct that has a table. Its object has members of the table alone.
template <class Struct>
void read_table(const Field& field, Struct& value) {
  allow_only(field, {}, [&](const auto& visit) { planning::visit_table(visit, value); });
  planning::visit_table(JsonReader(field), value);
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
  } else if constexpr (std::integral<Value>) {
    // A count or an index. That of a triangle may be a side of the bounds, which is below 0.
    constexpr bool kMayBeSide = std::same_as<Value, std::uint32_t>;
    read_integer(field, kMayBeSide ? -std::int64_t{geometry::Bounds::kSides} : 0, value);
  } else if constexpr (base::NamedEnum<Value>) {
    value = static_cast<Value>(named(field, names_of(Value{})));
  } else if constexpr (std::same_as<Value, geometry::Quat>) {
    geometry::Vec4 wxyz = geometry::Vec4::Zero();
    read_value(field, wxyz);
    value = geometry::from_wxyz(wxyz);  // of any length
  } else if constexpr (std::same_as<Value, geometry::Bounds>) {
    geometry::OptionalBounds limits;
    read_table(field, limits);
    value = geometry::bounds_of(limits);
  } else if constexpr (requires { Value::SizeAtCompileTime; }) {
    field.numbers(value.data(), Value::SizeAtCompileTime);
  } else if constexpr (requires { value.has_value(); }) {
    read_value(field, value.emplace());
  } else if constexpr (requires(const JsonReader& io) { planning::visit_table(io, value); }) {
    read_table(field, value);
  } else if constexpr (requires(const JsonReader& io) { planning::members(io, value); }) {
    const JsonReader io(field);
    planning::members(io, value);
  } else {
    read_list(field, value, [](const Field& item, auto& element) {
      if constexpr (std::same_as<decltype(element), std::uint32_t&>) {
        read_integer(item, 0, element);  // the index of a triangle or a vertex
      } else if (!requires { element.reset(); } || !item.is_null()) {
        read_value(item, element);  // null is no limit of bounds
      }
    });
  }
}

}  // namespace camway::tools
