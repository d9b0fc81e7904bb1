// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
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

/// The members of a wire type. The generated header specialises it:
///  - `kAll`: a tuple of `Plain`, `Text` and `List`, in wire order, counts left out;
///  - `kHas<Other>`: for each element of `kAll`, whether the struct `Other` has a member of that
///  name;
///  - `common(message, other, visit)`: calls `visit` with both members for each name in common.
template <class Message>
struct Members;

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

/// Whether `names` are those members of `Message` that `Other` does not have. For a
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
