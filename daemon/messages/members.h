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
#include <tuple>
#include <type_traits>
#include <vector>

#include "daemon/base/named_enum.h"
#include "daemon/messages/bounds.h"
#include "daemon/messages/convert.h"
#include "daemon/planning/result/members.h"

/// Conversion between planning's structs and messages, member by member: `ToWire` and `FromWire`
/// follow the lists of `planning/result/members.h`. Structs whose members have the same names need
/// no list.
namespace camway::messages {

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
inline void put(const std::string& mine, std::string& wire) { wire = mine; }
inline void put(std::tuple<const double&, const double&> mine, std::tuple<double&, double&> wire) {
  wire = mine;
}
/// No index is -1.
inline void put(std::optional<std::size_t> mine, std::int32_t& wire) {
  wire = mine ? static_cast<std::int32_t>(*mine) : -1;
}

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
inline void read(const std::string& wire, std::string& mine) { mine = wire; }
inline void read(std::tuple<const double&, const double&> wire, std::tuple<double&, double&> mine) {
  mine = wire;
}
inline void read(std::int32_t wire, std::optional<std::size_t>& mine) {
  if (wire >= 0) mine = static_cast<std::size_t>(wire);
}

/// Calls `io(mine.member, wire.member)` for each member of a message of which `Mine` has all
/// members by the same names.
template <class Io, class Mine, wire::Described Wire>
void convert_by_name(const Io& io, Mine& mine, Wire& wire) {
  using Message = std::remove_const_t<Wire>;
  static_assert(wire::lacks_only<Message, std::remove_const_t<Mine>>({}),
                "structs that differ need a list in planning/result/members.h");
  wire::Members<Message>::common(
      wire, mine, [&io](auto& wire_member, auto& member) { io(member, wire_member); });
}

/// Cuts the texts of a message to its limits.
template <wire::Described Wire>
void clip_texts(Wire& wire) {
  wire::for_each_member<Wire>([&](const auto& described) {
    if constexpr (requires { described.max_bytes; }) {
      std::string& text = wire.*described.member;
      text = clipped(text, described.max_bytes);
    }
  });
}

/// What `ToWire` and `FromWire` have in common: in messages, members have no names or lines, none
/// is left out, and a group is a part of the struct around it.
template <class Io>
struct Converter {
  template <class Mine, class Wire>
  void need(planning::FileName, Mine&& mine, Wire&& wire) const {
    io()(mine, wire);
  }
  template <class Mine, class Wire>
  void may(planning::FileName, bool, Mine&& mine, Wire&& wire) const {
    io()(mine, wire);
  }
  template <class List>
  void group(planning::FileName, bool, int, const List& list) const {
    list(io());
  }
  void line(int) const {}

 private:
  [[nodiscard]] const Io& io() const { return static_cast<const Io&>(*this); }
};

struct ToWire : Converter<ToWire> {
  template <class Mine, class Wire>
  void operator()(const Mine& mine, Wire& wire) const {
    if constexpr (requires { put(mine, wire); }) {
      put(mine, wire);
    } else if constexpr (requires { planning::members(*this, mine, wire); }) {
      planning::members(*this, mine, wire);
      clip_texts(wire);
    } else {
      convert_by_name(*this, mine, wire);
    }
  }
  template <class Mine, class Wire>
  void operator()(const std::vector<Mine>& mine, std::vector<Wire>& wire) const {
    wire.reserve(mine.size());
    for (const Mine& element : mine) (*this)(element, wire.emplace_back());
  }
  template <class Mine, class List>
  void optional(planning::FileName, const std::optional<Mine>& mine, const List& list,
                std::int8_t& has) const {
    has = mine ? 1 : 0;
    if (mine) list(*this, *mine);
  }
};

struct FromWire : Converter<FromWire> {
  template <class Mine, class Wire>
  void operator()(Mine& mine, const Wire& wire) const {
    if constexpr (requires { read(wire, mine); }) {
      read(wire, mine);
    } else if constexpr (requires { planning::members(*this, mine, wire); }) {
      planning::members(*this, mine, wire);
    } else {
      convert_by_name(*this, mine, wire);
    }
  }
  template <class Mine, class Wire>
  void operator()(std::vector<Mine>& mine, const std::vector<Wire>& wire) const {
    mine.reserve(wire.size());
    for (const Wire& element : wire) (*this)(mine.emplace_back(), element);
  }
  template <class Mine, class List>
  void optional(planning::FileName, std::optional<Mine>& mine, const List& list,
                std::int8_t has) const {
    if (has != 0) list(*this, mine.emplace());
  }
};

}  // namespace camway::messages
