// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "daemon/base/named_enum.h"
#include "daemon/messages/plan.h"
#include "daemon/messages/text.h"
#include "daemon/planning/request/option_table.h"
#include "daemon/planning/request/options.h"
#include "daemon/planning/result/result_members.h"
#include "lcmtypes/wire/convert.h"

/// Conversion between planning's structs and messages, member by member: `ToWire` and `FromWire`
/// follow the lists of `planning/result/result_members.h`. Structs whose members have the same
/// names need no list, and other values follow from their types (`wire::convert`).
namespace camway::messages {

/// The first fault of a request that is read. It names the member as the message does.
class Refusal {
 public:
  /// Keeps a reference to the message.
  explicit Refusal(const plan_request_t& message) : message_(message) {}

  /// Refuses a part of the message, e.g. "bounds.min_m[1]: " and the reason.
  template <class Part>
  void add(const Part& part, const std::string& reason) {
    if (error_.empty()) error_ = path_of(part) + ": " + reason;
  }
  /// Returns the path of a part of the message.
  template <class Part>
  [[nodiscard]] std::string path_of(const Part& part) const {
    return *wire::path_of(&part, sizeof part, message_);
  }
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  const plan_request_t& message_;
  std::string error_;
};

template <class Numbers>
void translate(const geometry::Quat& mine, Numbers& wire) {
  std::copy_n(geometry::wxyz(mine).data(), 4, std::begin(wire));
}
inline void translate(const double (&wire)[4], geometry::Quat& mine) {
  mine = geometry::from_wxyz({wire[0], wire[1], wire[2], wire[3]});
}
inline void translate(const geometry::Bounds& mine, bounds_t& wire) { wire = to_wire(mine); }
inline void translate(const bounds_t& wire, geometry::Bounds& mine) { mine = from_wire(wire); }
/// No index is -1.
inline void translate(const std::same_as<std::optional<std::size_t>> auto& mine,
                      std::int32_t& wire) {
  wire = mine ? static_cast<std::int32_t>(*mine) : -1;
}
template <base::NamedEnum Enum>
void translate(Enum mine, std::string& wire) {
  wire = base::name_of(mine);
}
/// Returns what a receiver of messages says of a name or number that no value has: "'magic' is
/// unknown; the values are ladder, keyframe_insertion", "9 is unknown; the values are 0 (closest),
/// 1 (shortest)".
template <class Wire, class Names>
std::string unknown_value(const Wire& wire, const Names& names) {
  constexpr bool kIsName = std::is_same_v<Wire, std::string>;
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    list += list.empty() ? "" : ", ";
    list += kIsName ? std::string(names[i]) : fmt::format("{} ({})", i, names[i]);
  }
  return fmt::format(
      kIsName ? "'{}' is unknown; the values are {}" : "{} is unknown; the values are {}", wire,
      list);
}
/// Reads the number or the name of a value.
template <class Wire, base::NamedEnum Enum>
void translate(const Wire& wire, Enum& mine, Refusal& refusal) {
  const std::optional<Enum> value = base::value_of<Enum>(wire);
  if (!value) refusal.add(wire, unknown_value(wire, names_of(Enum{})));
  mine = value.value_or(mine);
}
/// Reads the index of a vertex, or a seed.
template <std::signed_integral Wire, std::unsigned_integral Mine>
requires(sizeof(Wire) == sizeof(Mine) &&
         !std::same_as<Mine, bool>) void translate(const Wire& wire, Mine& mine, Refusal& refusal) {
  if (wire < 0) refusal.add(wire, fmt::format("is {}; it must be at least 0", wire));
  mine = static_cast<Mine>(wire);
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

/// Writes messages or reads them. In messages, members have no names or lines, none is left out,
/// and a group is a part of the struct around it.
template <bool kWrites>
class Converter {
 public:
  Converter() = default;
  /// For values that may be refused.
  explicit Converter(Refusal& refusal) requires(!kWrites) : refusal_(&refusal) {}

  template <class Mine, class Wire>
  void operator()(Mine&& mine, Wire&& wire) const {
    if constexpr (requires { planning::visit_table(*this, mine, wire); }) {
      planning::visit_table(*this, mine, wire);
    } else if constexpr (requires { planning::members(*this, mine, wire); }) {
      planning::members(*this, mine, wire);
      if constexpr (kWrites && wire::Described<std::remove_reference_t<Wire>>) clip_texts(wire);
    } else if constexpr (kWrites) {
      convert(*this, mine, wire);
    } else {
      convert([this](const auto& from, auto& to) { (*this)(to, from); }, wire, mine);
    }
  }

  /// Converts a member of a list.
  template <class Mine, class Wire>
  void operator()(planning::FileName, Mine&& mine, Wire&& wire) const {
    (*this)(mine, wire);
  }
  /// Converts a member of a field table. One that is zero or empty in a message that is read leaves
  /// the default; NaN and negative values go on to `planning::validate`.
  template <std::same_as<planning::FieldSpec> Spec, class Mine, class Wire>
  void operator()(const Spec&, Mine& mine, Wire& wire) const {
    if constexpr (!kWrites) {
      if (wire::is_blank(wire)) return;
    }
    (*this)(mine, wire);
  }
  template <class List>
  void group(planning::FileName, int, const List& list) const {
    list(*this);
  }
  template <class Mine, class List>
  void optional(planning::FileName, const Mine& mine, const List& list, std::int8_t& has) const {
    has = mine ? 1 : 0;
    if (mine) list(*this, *mine);
  }
  template <class Mine, class List>
  void optional(planning::FileName, std::optional<Mine>& mine, const List& list,
                const std::int8_t& has) const requires(!kWrites) {
    mine.reset();
    if (has != 0) list(*this, mine.emplace());
  }

 protected:
  /// Converts a value by `translate` where there is one for its types.
  template <class Io, class From, class To>
  void convert(const Io& io, const From& from, To& to) const {
    if constexpr (requires { translate(from, to); }) {
      translate(from, to);
    } else if constexpr (requires(Refusal & refusal) { translate(from, to, refusal); }) {
      translate(from, to, *refusal_);
    } else {
      wire::convert(io, from, to);
    }
  }

  Refusal* refusal_ = nullptr;
};

using ToWire = Converter<true>;
using FromWire = Converter<false>;

}  // namespace camway::messages
