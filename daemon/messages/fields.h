// SPDX-License-Identifier: MIT
#pragma once

#include <camway/members.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "daemon/base/named_enum.h"
#include "daemon/messages/bounds.h"
#include "daemon/motion/path/keyframe.h"

/// Conversion between planning's structs and messages, member by member. For two structs there is
/// one list of pairs: a function `pair(io, mine, wire)` that calls `io(mine.member, wire.member)`
/// for each member. It serves both directions: `io` is `ToWire` or `FromWire`. Structs whose
/// members have the same names need no list.
namespace camway::messages {

template <class T, class Struct>
concept Is = std::same_as<std::remove_const_t<T>, Struct>;

template <class Number>
requires std::is_arithmetic_v<Number>
void put(Number mine, std::integral auto& wire) {
  wire = static_cast<std::remove_reference_t<decltype(wire)>>(mine);
}
inline void put(double mine, double& wire) { wire = mine; }
template <base::NamedEnum Enum>
void put(Enum mine, std::integral auto& wire) {
  wire = static_cast<std::remove_reference_t<decltype(wire)>>(mine);
}
template <int kSize, std::size_t kCount>
requires(kCount == kSize) void put(const Eigen::Matrix<double, kSize, 1>& mine,
                                   double (&wire)[kCount]) {
  std::copy_n(mine.data(), kCount, wire);
}
inline void put(const geometry::Quat& mine, double (&wire)[4]) { put(geometry::wxyz(mine), wire); }
template <class Vector, std::size_t kCount, std::size_t kSize>
void put(const std::array<Vector, kCount>& mine, double (&wire)[kCount][kSize]) {
  for (std::size_t i = 0; i < kCount; ++i) put(mine[i], wire[i]);
}
inline void put(const geometry::Bounds& mine, bounds_t& wire) { wire = wire_bounds(mine); }

template <class Number>
requires std::is_arithmetic_v<Number>
void read(std::integral auto wire, Number& mine) { mine = static_cast<Number>(wire); }
inline void read(std::integral auto wire, bool& mine) { mine = wire != 0; }
inline void read(double wire, double& mine) { mine = wire; }
/// A number that is no value leaves `mine` as it is.
template <base::NamedEnum Enum>
void read(std::integral auto wire, Enum& mine) {
  mine = base::value_of<Enum>(wire).value_or(mine);
}
template <int kSize, std::size_t kCount>
requires(kCount == kSize) void read(const double (&wire)[kCount],
                                    Eigen::Matrix<double, kSize, 1>& mine) {
  std::copy_n(wire, kCount, mine.data());
}
inline void read(const double (&wire)[4], geometry::Quat& mine) {
  mine = geometry::from_wxyz({wire[0], wire[1], wire[2], wire[3]});
}
template <class Vector, std::size_t kCount, std::size_t kSize>
void read(const double (&wire)[kCount][kSize], std::array<Vector, kCount>& mine) {
  for (std::size_t i = 0; i < kCount; ++i) read(wire[i], mine[i]);
}
inline void read(const bounds_t& wire, geometry::Bounds& mine) { mine = bounds_of(wire); }

template <class Io>
void pair(const Io& io, Is<motion::Keyframe> auto& mine, Is<keyframe_t> auto& wire) {
  io(mine.time_s, wire.time_s);
  io(mine.pose.position, wire.position_m);
  io(mine.pose.orientation, wire.orientation_wxyz);
  io(mine.origin, wire.origin);
  io(mine.is_repaired, wire.repaired);
}

/// Calls `io(mine.member, wire.member)` for each name that both structs have.
template <class Io, class Mine, wire::Described Wire>
void pair_common(const Io& io, Mine& mine, Wire& wire) {
  wire::Members<std::remove_const_t<Wire>>::common(
      wire, mine, [&io](auto& wire_member, auto& member) { io(member, wire_member); });
}

/// Converts structs of which `Mine` has all members of the message, by the same names.
template <class Io, class Mine, wire::Described Wire>
void pair_all(const Io& io, Mine& mine, Wire& wire) {
  static_assert(wire::lacks_only<std::remove_const_t<Wire>, std::remove_const_t<Mine>>({}),
                "structs that differ need a `pair`");
  pair_common(io, mine, wire);
}

struct ToWire {
  template <class Mine, class Wire>
  void operator()(const Mine& mine, Wire& wire) const {
    if constexpr (requires { put(mine, wire); }) {
      put(mine, wire);
    } else if constexpr (requires { pair(*this, mine, wire); }) {
      pair(*this, mine, wire);
    } else {
      pair_all(*this, mine, wire);
    }
  }
  template <class Mine, class Wire>
  void operator()(const std::vector<Mine>& mine, std::vector<Wire>& wire) const {
    wire.reserve(mine.size());
    for (const Mine& element : mine) (*this)(element, wire.emplace_back());
  }
  /// Converts a member that may be missing: calls `each(*mine)` if it is there.
  template <class Mine, class Each>
  void optional(const std::optional<Mine>& mine, std::int8_t& has, const Each& each) const {
    has = mine ? 1 : 0;
    if (mine) each(*mine);
  }
};

struct FromWire {
  template <class Mine, class Wire>
  void operator()(Mine& mine, const Wire& wire) const {
    if constexpr (requires { read(wire, mine); }) {
      read(wire, mine);
    } else if constexpr (requires { pair(*this, mine, wire); }) {
      pair(*this, mine, wire);
    } else {
      pair_all(*this, mine, wire);
    }
  }
  template <class Mine, class Wire>
  void operator()(std::vector<Mine>& mine, const std::vector<Wire>& wire) const {
    mine.reserve(wire.size());
    for (const Wire& element : wire) (*this)(mine.emplace_back(), element);
  }
  template <class Mine, class Each>
  void optional(std::optional<Mine>& mine, std::int8_t has, const Each& each) const {
    if (has != 0) each(mine.emplace());
  }
};

}  // namespace camway::messages
