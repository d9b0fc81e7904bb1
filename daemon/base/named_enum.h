// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

namespace camway::base {

/// An enumeration whose values count from 0, as they do on the wire. A function `names_of` in
/// its namespace returns an array of the names, in order of the values.
template <class Enum>
concept NamedEnum = std::is_enum_v<Enum> && requires {
  names_of(Enum{});
};

/// Returns the name of a value; "unknown" for a number that is no value.
template <NamedEnum Enum>
constexpr std::string_view name_of(Enum value) {
  const auto names = names_of(value);
  const auto index = static_cast<std::size_t>(value);
  return index < names.size() ? names[index] : "unknown";
}

/// Returns the value of a name; nothing for a name that no value has.
template <NamedEnum Enum>
constexpr std::optional<Enum> value_of(std::string_view name) {
  const auto names = names_of(Enum{});
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Enum>(found - names.begin());
}

/// Returns the value of a number; nothing for a number that no value has.
template <NamedEnum Enum>
constexpr std::optional<Enum> value_of(std::integral auto number) {
  if (number < 0 || std::cmp_greater_equal(number, names_of(Enum{}).size())) return std::nullopt;
  return static_cast<Enum>(number);
}

/// Returns the names with their values, for choices on a command line.
template <NamedEnum Enum>
constexpr auto named_values() {
  constexpr auto kNames = names_of(Enum{});
  std::array<std::pair<std::string_view, Enum>, kNames.size()> pairs{};
  for (std::size_t i = 0; i < kNames.size(); ++i) pairs[i] = {kNames[i], static_cast<Enum>(i)};
  return pairs;
}

}  // namespace camway::base
