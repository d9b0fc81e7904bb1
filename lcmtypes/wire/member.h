// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

/// The members of the wire types as data, for code that treats all of them alike. The header
/// `camway/members.h`, which `generate_layout.py` writes from the .lcm files, has them.
namespace camway::wire {

/// A number, an array of constant size, or a struct.
template <class Pointer>
struct Plain {
  std::string_view name;
  Pointer member;
};
template <class Pointer>
Plain(const char*, Pointer) -> Plain<Pointer>;

template <class Message>
struct Text {
  std::string_view name;
  std::string Message::*member;
  std::size_t max_bytes;  ///< without the final NUL
};
template <class Message>
Text(const char*, std::string Message::*, int) -> Text<Message>;

/// A list, and the member that counts its elements.
template <class Message, class Element>
struct List {
  std::string_view name;
  std::vector<Element> Message::*member;
  std::int32_t Message::*count;
  std::size_t columns;  ///< numbers in an element that is an array; else 0
};
template <class Message, class Element>
List(const char*, std::vector<Element> Message::*, std::int32_t Message::*, int)
    -> List<Message, Element>;

/// A flag `has_x`, and a member that counts only with it: `x`, or each of `x_...` if there is no
/// `x`. Flag and member may be arrays, which go by elements.
template <class FlagPointer, class Pointer>
struct Mark {
  FlagPointer flag;
  Pointer member;
};
template <class FlagPointer, class Pointer>
Mark(FlagPointer, Pointer) -> Mark<FlagPointer, Pointer>;

/// The members of a wire type. The generated header specialises it:
///  - `kAll`: a tuple of `Plain`, `Text` and `List`, in wire order, counts left out;
///  - `kMarks`: a tuple of `Mark`;
///  - `common(message, other, visit)`: calls `visit` with a member of the message and its partner
///    in the struct `other`, for each that has one. The partner of `x` is `x`, that of `x_y` may be
///    `x.y`. `has_x` follows from the optional `x` of `other`, or the other way round;
///  - `kHas<Other>`: for each element of `kAll`, whether it has a partner.
template <class Message>
struct Members;

/// Returns the struct that members of a message are a part of; null for an optional that is empty
/// and cannot be filled.
template <class Struct>
auto* group(Struct& members) {
  if constexpr (requires { members.has_value(); }) {
    if constexpr (!std::is_const_v<Struct>) {
      if (!members) members.emplace();
    }
    return members ? &*members : nullptr;
  } else {
    return &members;
  }
}

/// Writes the flag of an optional member.
template <class Value>
void mark(std::int8_t& flag, const std::optional<Value>& member) {
  flag = member ? 1 : 0;
}
/// Empties an optional member that was read although its flag is not set.
template <class Value>
void mark(const std::int8_t& flag, std::optional<Value>& member) {
  if (flag == 0) member.reset();
}
template <class Flag, std::size_t kCount, class List>
requires requires(Flag& flag, List& members) { mark(flag, members[0]); }
void mark(Flag (&flags)[kCount], List& members) {
  for (std::size_t i = 0; i < kCount; ++i) mark(flags[i], members[i]);
}

template <class Message>
concept Described = requires {
  Members<std::remove_const_t<Message>>::kAll;
};

/// Calls `visit` with the `Plain`, `Text` or `List` of each member.
template <Described Message, class Visit>
void for_each_member(const Visit& visit) {
  std::apply([&](const auto&... members) { (visit(members), ...); }, Members<Message>::kAll);
}

/// Calls `visit(pointer to the list, pointer to its count)` for each list.
template <Described Message, class Visit>
void for_each_list(const Visit& visit) {
  for_each_member<Message>([&](const auto& member) {
    if constexpr (requires { member.count; }) visit(member.member, member.count);
  });
}

/// Sets the counts of a message to the sizes of its lists.
template <Described Message>
void set_counts(Message& message) {
  for_each_list<Message>([&](auto list, auto count) {
    message.*count = static_cast<std::int32_t>((message.*list).size());
  });
}

/// Whether a member of a message is as a sender leaves it that does not set it: zero or empty.
template <class Member>
bool is_blank(const Member& member) {
  if constexpr (Described<Member>) {
    bool blank = true;
    for_each_member<Member>(
        [&](const auto& part) { blank = blank && is_blank(member.*part.member); });
    return blank;
  } else if constexpr (std::is_array_v<Member>) {
    return std::all_of(std::begin(member), std::end(member),
                       [](const auto& element) { return is_blank(element); });
  } else if constexpr (std::is_arithmetic_v<Member>) {
    return member == Member{};
  } else {
    return member.empty();
  }
}

/// Calls `visit(member, flag)` for a member that has a value although its flag is not set.
template <class Flag, class Member, class Visit>
void visit_unmarked(const Flag& flag, const Member& member, const Visit& visit) {
  if constexpr (std::is_array_v<Flag>) {
    for (std::size_t i = 0; i < std::extent_v<Flag>; ++i) visit_unmarked(flag[i], member[i], visit);
  } else if (flag == 0 && !is_blank(member)) {
    visit(member, flag);
  }
}
/// Visits such members of a message and of the structs in it, but not of its lists.
template <Described Message, class Visit>
void visit_unmarked(const Message& message, const Visit& visit) {
  std::apply(
      [&](const auto&... marks) {
        (visit_unmarked(message.*marks.flag, message.*marks.member, visit), ...);
      },
      Members<Message>::kMarks);
  for_each_member<Message>([&](const auto& described) {
    using Member = std::remove_cvref_t<decltype(message.*described.member)>;
    if constexpr (Described<Member>) visit_unmarked(message.*described.member, visit);
  });
}

/// Calls `visit(name, member)` for each member of a message that has a value although it is not
/// among `used`, the addresses of the members that count.
template <Described Message, class Visit>
void visit_unused(const Message& message, const std::vector<const void*>& used,
                  const Visit& visit) {
  for_each_member<Message>([&](const auto& described) {
    const auto& member = message.*described.member;
    const void* const address = &member;
    const bool counts = std::find(used.begin(), used.end(), address) != used.end();
    if (!counts && !is_blank(member)) visit(described.name, member);
  });
}

/// Returns the path of the part of `whole` that has this address and size, for example
/// "bounds.min_m[1]"; nothing if `whole` has no such part.
template <class Whole>
std::optional<std::string> path_of(const void* part, std::size_t size, const Whole& whole) {
  if (&whole == part && sizeof(whole) == size) return "";
  std::optional<std::string> path;
  const auto look_in = [&](const auto& member, const std::string& name) {
    if (path) return;
    path = path_of(part, size, member);
    if (path) path->insert(0, path->empty() || path->front() == '[' ? name : name + ".");
  };
  if constexpr (Described<Whole>) {
    for_each_member<Whole>([&](const auto& described) {
      look_in(whole.*described.member, std::string(described.name));
    });
  } else if constexpr (requires { whole[0]; } && !std::is_same_v<Whole, std::string>) {
    for (std::size_t i = 0; i < std::size(whole); ++i) {
      look_in(whole[i], "[" + std::to_string(i) + "]");
    }
  }
  return path;
}

/// Whether `names` are those members of `Message` that have no partner in `Other`. For a
/// `static_assert` beside `common`, which passes over them.
template <Described Message, class Other>
constexpr bool lacks_only(std::initializer_list<std::string_view> names) {
  std::size_t lacking = 0;
  const bool are_named = std::apply(
      [&](const auto&... members) {
        std::size_t i = 0;
        const auto passes = [&](std::string_view name) {
          if (Members<Message>::template kHas<Other>[i++]) return true;
          ++lacking;
          return std::find(names.begin(), names.end(), name) != names.end();
        };
        return (passes(members.name) && ...);
      },
      Members<Message>::kAll);
  return are_named && lacking == names.size();
}

}  // namespace camway::wire
