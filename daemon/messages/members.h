// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "daemon/base/named_enum.h"
#include "daemon/messages/bounds.h"
#include "daemon/messages/convert.h"
#include "daemon/planning/result/members.h"
#include "lcmtypes/wire/convert.h"

/// Conversion between planning's structs and messages, member by member: `ToWire` and `FromWire`
/// follow the lists of `planning/result/members.h`. Structs whose members have the same names need
/// no list, and other values follow from their types (`wire::convert`).
namespace camway::messages {

inline void translate(const geometry::Quat& mine, double (&wire)[4]) {
  std::copy_n(geometry::wxyz(mine).data(), 4, wire);
}
inline void translate(const double (&wire)[4], geometry::Quat& mine) {
  mine = geometry::from_wxyz({wire[0], wire[1], wire[2], wire[3]});
}
/// No index is -1.
inline void translate(const std::same_as<std::optional<std::size_t>> auto& mine,
                      std::int32_t& wire) {
  wire = mine ? static_cast<std::int32_t>(*mine) : -1;
}
inline void translate(std::int32_t wire, std::optional<std::size_t>& mine) {
  if (wire >= 0) mine = static_cast<std::size_t>(wire);
}
/// A number that is no value leaves `mine` as it is.
template <base::NamedEnum Enum>
void translate(std::integral auto wire, Enum& mine) {
  mine = base::value_of<Enum>(wire).value_or(mine);
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

/// Converts a value by `translate` where there is one for its types.
template <class Io, class From, class To>
void convert(const Io& io, const From& from, To& to) {
  if constexpr (requires { translate(from, to); }) {
    translate(from, to);
  } else {
    wire::convert(io, from, to);
  }
}

/// Writes messages or reads them. In messages, members have no names or lines, none is left out,
/// and a group is a part of the struct around it.
template <bool kWrites>
struct Converter {
  template <class Mine, class Wire>
  void operator()(Mine&& mine, Wire&& wire) const {
    if constexpr (requires { planning::members(*this, mine, wire); }) {
      planning::members(*this, mine, wire);
      if constexpr (kWrites) clip_texts(wire);
    } else if constexpr (kWrites) {
      convert(*this, mine, wire);
    } else {
      convert([this](const auto& from, auto& to) { (*this)(to, from); }, wire, mine);
    }
  }

  template <class Mine, class Wire>
  void need(planning::FileName, Mine&& mine, Wire&& wire) const {
    (*this)(mine, wire);
  }
  template <class Mine, class Wire>
  void may(planning::FileName, bool, Mine&& mine, Wire&& wire) const {
    (*this)(mine, wire);
  }
  template <class List>
  void group(planning::FileName, bool, int, const List& list) const {
    list(*this);
  }
  template <class Mine, class List, class Has>
  void optional(planning::FileName, Mine& mine, const List& list, Has& has) const {
    if constexpr (kWrites) {
      has = mine ? 1 : 0;
    } else if (has != 0) {
      mine.emplace();
    }
    if (mine) list(*this, *mine);
  }
  void line(int) const {}
};

using ToWire = Converter<true>;
using FromWire = Converter<false>;

}  // namespace camway::messages
