// SPDX-License-Identifier: MIT
#pragma once

#include <camway/members.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <tuple>
#include <type_traits>

/// Conversions between messages and the structs of daemon and client, which follow from the types
/// alone. Daemon and client add the pairs of types that are different in name or form.
namespace camway::wire {

/// Number of elements of an array or of a vector of Eigen; 0 for other types.
template <class T>
constexpr std::size_t length_of() {
  if constexpr (std::is_array_v<T>) return std::extent_v<T>;
  if constexpr (requires(const T& t) { std::tuple_size<T>::value, t.data(); }) {
    return std::tuple_size_v<T>;
  }
  if constexpr (requires { T::SizeAtCompileTime; }) return T::SizeAtCompileTime;
  return 0;
}

template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Converts each member of a message that has a partner in a struct (`Members`). Calls
/// `io(from, to)` for the members.
template <class Io, class From, class To>
void convert_common(const Io& io, const From& from, To& to) {
  if constexpr (Described<From>) {
    Members<From>::common(from, to, io);
  } else {
    Members<To>::common(to, from, [&io](auto& into, const auto& member) { io(member, into); });
  }
}

/// Converts a struct that has a partner of every member of the message; otherwise it does not
/// compile.
template <class Io, class From, class To>
void convert_whole(const Io& io, const From& from, To& to) {
  if constexpr (Described<From>) {
    static_assert(lacks_only<From, To>({}), "structs that differ need a conversion of their own");
  } else {
    static_assert(lacks_only<To, From>({}), "structs that differ need a conversion of their own");
  }
  convert_common(io, from, to);
}

/// Converts a value of a message to one of a struct, or the other way: numbers and enumerations by
/// `static_cast`, arrays and lists by their elements, structs by their members. Calls
/// `io(from, to)` for elements and members. Requires `to` as it is by default: lists are appended
/// to. An empty optional leaves `to` as it is; none is empty afterwards, but by its flag `has_...`.
template <class Io, class From, class To>
void convert(const Io& io, const From& from, To& to) {
  if constexpr (Number<From> && Number<To>) {
    static_assert(std::is_floating_point_v<From> == std::is_floating_point_v<To>);
    to = static_cast<To>(from);
  } else if constexpr (std::is_assignable_v<To&, const From&>) {
    to = from;
  } else if constexpr (requires { from.has_value(); }) {
    if (from) io(*from, to);
  } else if constexpr (requires { to.has_value(); }) {
    io(from, to.emplace());
  } else if constexpr (length_of<From>() > 0 || length_of<To>() > 0) {
    constexpr std::size_t kLength = std::max(length_of<From>(), length_of<To>());
    if constexpr (length_of<To>() == 0) {
      to.resize(kLength);
    } else {
      static_assert(length_of<From>() == 0 || length_of<From>() == length_of<To>());
    }
    auto element = std::begin(from);
    auto into = std::begin(to);
    for (std::size_t i = 0; i < kLength; ++i) io(*element++, *into++);
  } else if constexpr (requires { to.emplace_back(); }) {
    to.reserve(to.size() + std::size(from));
    for (const auto& element : from) io(element, to.emplace_back());
  } else {
    convert_whole(io, from, to);
  }
}

}  // namespace camway::wire
