// SPDX-License-Identifier: MIT
#pragma once

#include <camway/members.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

/// Converts between the client's structs and the messages: `put(mine, wire)` writes a message,
/// `read(wire, mine)` reads one. `put` and `read` copy every member that the struct and the message
/// have under the same name. A struct needs its own overload only for members whose name or form
/// differs from the message. `put` expects `wire` to be value-initialised; `read` appends to lists.
namespace camway {

template <class T>
void put(const T& mine, T& wire) {
  wire = mine;
}
inline void put(bool mine, std::int8_t& wire) { wire = mine ? 1 : 0; }
template <class Enum>
requires std::is_enum_v<Enum>
void put(Enum mine, std::integral auto& wire) {
  wire = static_cast<std::remove_reference_t<decltype(wire)>>(mine);
}
template <class T, std::size_t N>
void put(const std::array<T, N>& mine, T (&wire)[N]) {
  std::copy(mine.begin(), mine.end(), wire);
}
/// Writes the value; an empty optional leaves `wire` at 0.
template <class Mine, class Wire>
void put(const std::optional<Mine>& mine, Wire& wire) {
  if (mine) put(*mine, wire);
}

template <class T>
void read(const T& wire, T& mine) {
  mine = wire;
}
inline void read(std::int8_t wire, bool& mine) { mine = wire != 0; }
template <class Enum>
requires std::is_enum_v<Enum>
void read(std::integral auto wire, Enum& mine) { mine = static_cast<Enum>(wire); }
template <class T, std::size_t N>
void read(const T (&wire)[N], std::array<T, N>& mine) {
  std::copy(wire, wire + N, mine.begin());
}
template <class T, std::size_t M, std::size_t N>
void read(const T (&wire)[M][N], std::array<std::array<T, N>, M>& mine) {
  for (std::size_t i = 0; i < M; ++i) read(wire[i], mine[i]);
}
/// Reads the value. The optional is never empty afterwards.
template <class Wire, class Mine>
void read(const Wire& wire, std::optional<Mine>& mine) {
  read(wire, mine.emplace());
}

/// Writes every member that the struct and the message have under the same name.
template <class Mine, wire::Described Wire>
void put_common(const Mine& mine, Wire& wire) {
  wire::Members<Wire>::common(wire, mine, [](auto& to, const auto& from) { put(from, to); });
}
/// Writes a struct that has every member of the message under the same name; otherwise it does not
/// compile.
template <class Mine, wire::Described Wire>
requires(!std::same_as<Mine, Wire>) void put(const Mine& mine, Wire& wire) {
  static_assert(wire::lacks_only<Wire, Mine>({}), "a pair that differs needs a `put` of its own");
  put_common(mine, wire);
}
template <class Mine, class Wire>
requires(!std::same_as<Mine, Wire>) void put(const std::vector<Mine>& mine,
                                             std::vector<Wire>& wire) {
  for (const Mine& element : mine) put(element, wire.emplace_back());
}

/// Reads every member that the struct and the message have under the same name.
template <wire::Described Wire, class Mine>
void read_common(const Wire& wire, Mine& mine) {
  wire::Members<Wire>::common(wire, mine, [](const auto& from, auto& to) { read(from, to); });
}
/// Reads a struct that has every member of the message under the same name; otherwise it does not
/// compile.
template <wire::Described Wire, class Mine>
requires(!std::same_as<Mine, Wire>) void read(const Wire& wire, Mine& mine) {
  static_assert(wire::lacks_only<Wire, Mine>({}), "a pair that differs needs a `read` of its own");
  read_common(wire, mine);
}
template <class Wire, class Mine>
requires(!std::same_as<Mine, Wire>) void read(const std::vector<Wire>& wire,
                                              std::vector<Mine>& mine) {
  for (const Wire& element : wire) read(element, mine.emplace_back());
}

}  // namespace camway
