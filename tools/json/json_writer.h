// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "daemon/base/named_enum.h"
#include "daemon/collision/obstacles.h"
#include "daemon/planning/result/members.h"
#include "tools/json/json_angle.h"

namespace camway::tools {

using planning::FileName;

/// Writes an object. Each small object (a keyframe, an interval) is on one line, so that a person
/// can read a long path and `diff` can compare two.
class JsonWriter {
 public:
  explicit JsonWriter(std::string& out) : out_(out) {}

  /// Writes the whole object, whose members `write` writes. Each member is on a line of its own
  /// that begins with `indent` spaces; if `indent` is below 0, all are on one line.
  template <class Write>
  void object(int indent, const Write& write) {
    const int outer = std::exchange(indent_, indent);
    out_ += '{';
    is_first_ = true;
    write();
    if (indent_ >= 0) new_line(indent_ - 2);
    out_ += '}';
    is_first_ = false;
    indent_ = outer;
  }

  /// Begins a line with `indent` spaces for the next member.
  void line(int indent) { line_ = indent; }

  /// Writes a member (`planning/result/members.h`).
  template <class Value>
  void need(FileName name, const Value& member) {
    begin(name.name);
    if constexpr (std::same_as<Value, double>) {
      value(planning::is_angle(name.name) ? degrees(member) : member);
    } else {
      value(member);
    }
    path_.pop_back();
  }
  template <class Value>
  void may(FileName name, bool is_said, const Value& member) {
    if (is_said) need(name, member);
    line_ = -1;
  }
  template <class List>
  void group(FileName name, bool is_said, int indent, const List& list) {
    line_ = is_said ? line_ : -1;
    if (!is_said) return;
    begin(name.name);
    object(indent, [&] { list(*this); });
    path_.pop_back();
  }
  template <class Struct, class List>
  void optional(FileName name, const std::optional<Struct>& member, const List& list) {
    group(name, member.has_value(), -1, [&](JsonWriter& io) { list(io, *member); });
  }

  /// Returns the first member that could not be written, and why: "keyframes[].position: is not
  /// finite". Empty if there is none.
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  void new_line(int indent) { out_.append("\n").append(static_cast<std::size_t>(indent), ' '); }
  void begin(std::string_view name);

  void value(double number);
  void value(std::string_view text);
  /// Writes null for a side without a limit.
  void value(const geometry::Bounds& bounds);
  void value(const geometry::Quat& orientation) { array(geometry::wxyz(orientation)); }
  void value(std::tuple<const double&, const double&> both) {
    array(std::array{std::get<0>(both), std::get<1>(both)});
  }
  template <class Value>
  void value(const Value& value) {
    if constexpr (std::same_as<Value, bool>) {
      out_ += value ? "true" : "false";
    } else if constexpr (std::same_as<Value, std::uint32_t>) {
      // The index of a triangle, or a side of the bounds as a number below 0.
      out_ += std::to_string(collision::Obstacles::signed_number(value));
    } else if constexpr (std::integral<Value>) {
      out_ += std::to_string(value);
    } else if constexpr (base::NamedEnum<Value>) {
      this->value(base::name_of(value));
    } else if constexpr (std::convertible_to<Value, std::string_view>) {
      this->value(std::string_view(value));
    } else if constexpr (requires { value.has_value(); }) {
      this->value(*value);
    } else if constexpr (requires { planning::members(*this, value); }) {
      object(-1, [&] { planning::members(*this, value); });
    } else {
      array(value);
    }
  }

  /// Writes numbers and points on one line, and each element of another list on a line.
  template <class List>
  void array(const List& list) {
    using Element = std::remove_cvref_t<decltype(*list.begin())>;
    constexpr bool kIsInLine = std::is_arithmetic_v<Element> || requires {
      std::tuple_size<List>::value;
    };
    if (!kIsInLine) path_.emplace_back("[]");
    const char* separator = kIsInLine ? "[" : "[\n    ";
    for (const auto& element : list) {
      out_ += std::exchange(separator, kIsInLine ? ", " : ",\n    ");
      value(element);
    }
    out_ += list.size() == 0 ? "[]" : kIsInLine ? "]" : "\n  ]";
    if (!kIsInLine) path_.pop_back();
  }

  std::string& out_;
  std::string error_;
  std::vector<std::string_view> path_;  ///< names that lead to the value that is being written
  int indent_ = -1;
  int line_ = -1;
  bool is_first_ = true;
};

}  // namespace camway::tools
