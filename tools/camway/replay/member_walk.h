// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "daemon/base/named_enum.h"
#include "daemon/planning/result/members.h"

namespace camway::tools {

/// A step from a struct to a member, or from a list to an element.
struct MemberStep {
  std::string_view name;  ///< empty for an element
  std::size_t index = 0;
};
using MemberPath = std::vector<MemberStep>;

/// Turns an answer into words, in the order of `planning/result/members.h`: equal answers, and only
/// those, have equal words. A double is one word with its bits, a list its size and its elements.
/// Calls `sink.word(word, path)` for each word, and `sink.size(size, path)` for the size of a list.
/// Leaves out members that tell how an answer was found, and not what it is: wording, effort, and
/// whether the deadline was reached.
/// Not thread-safe.
template <class Sink>
class MemberWalk {
 public:
  explicit MemberWalk(Sink& sink) : sink_(sink) {}

  // The functions that the lists of members call.
  template <class Value>
  void need(planning::FileName name, const Value& member) {
    inside(name, [&] { visit(member); });
  }
  template <class Value>
  void may(planning::FileName name, bool, const Value& member) {
    need(name, member);
  }
  template <class List>
  void group(planning::FileName name, bool, int, const List& list) {
    inside(name, [&] { list(*this); });
  }
  template <class Struct, class List>
  void optional(planning::FileName name, const std::optional<Struct>& member, const List& list) {
    inside(name, [&] {
      visit(member.has_value());
      if (member) list(*this, *member);
    });
  }

 private:
  static bool is_left_out(std::string_view name) {
    constexpr std::array<std::string_view, 3> kLeftOut{"message", "tried", "deadline_reached"};
    return std::find(kLeftOut.begin(), kLeftOut.end(), name) != kLeftOut.end();
  }
  template <class Visit>
  void inside(planning::FileName name, const Visit& visit_inside) {
    if (is_left_out(name.name)) return;
    path_.push_back({name.name});
    visit_inside();
    path_.pop_back();
  }

  void visit(double number) { sink_.word(std::bit_cast<std::uint64_t>(number), path_); }
  template <class Number>
  requires std::integral<Number> || base::NamedEnum<Number>
  void visit(Number number) { sink_.word(static_cast<std::uint64_t>(number), path_); }
  void visit(const std::optional<std::size_t>& index) {
    visit(index.has_value());
    visit(index.value_or(0));
  }
  void visit(const std::tuple<const double&, const double&>& both) {
    visit(std::get<0>(both));
    visit(std::get<1>(both));
  }
  // A difference is one of the text, not of a character.
  void visit(const std::string& text) {
    sink_.size(text.size(), path_);
    for (const char character : text) visit(static_cast<unsigned char>(character));
  }
  template <int kSize>
  void visit(const Eigen::Matrix<double, kSize, 1>& vector) {
    for (const double number : vector) visit(number);
  }
  void visit(const geometry::Quat& orientation) { visit(geometry::wxyz(orientation)); }
  void visit(const geometry::Bounds& bounds) {
    visit(bounds.min_W);
    visit(bounds.max_W);
  }
  template <class Item, std::size_t kCount>
  void visit(const std::array<Item, kCount>& items) {
    for (const Item& item : items) visit(item);
  }
  template <class List>
  requires requires(const List& list) {
    list.size();
    list.data();
  }
  void visit(const List& list) {
    sink_.size(list.size(), path_);
    for (std::size_t i = 0; i < list.size(); ++i) {
      path_.push_back({{}, i});
      visit(list[i]);
      path_.pop_back();
    }
  }
  template <class Struct>
  requires requires(MemberWalk& io, const Struct& value) { planning::members(io, value); }
  void visit(const Struct& object) { planning::members(*this, object); }

  Sink& sink_;
  MemberPath path_;
};

}  // namespace camway::tools
