// SPDX-License-Identifier: MIT
#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

#include <nlohmann/json.hpp>

#include "daemon/base/named_enum.h"
#include "daemon/collision/obstacles.h"
#include "daemon/planning/request/body_members.h"
#include "daemon/planning/request/option_table.h"
#include "daemon/planning/result/result_members.h"
#include "daemon/scene/import/record/import_words.h"
#include "tools/json/json_angle.h"
#include "tools/json/json_request.h"
#include "tools/json/json_response.h"
#include "tools/json/json_text.h"

namespace camway::tools {
namespace {

using planning::FileName;
using planning::may_lack;

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

  /// Writes a member (`planning/result/result_members.h`).
  template <class Value>
  void operator()(FileName name, const Value& member) {
    if (!name.is_written) return;
    begin(name);
    if constexpr (std::same_as<Value, double>) {
      value(planning::is_angle(name.name) ? degrees(member) : member);
    } else {
      value(member);
    }
    path_.pop_back();
  }
  template <class List>
  void group(FileName name, int indent, const List& list) {
    if (!name.is_written) return;
    begin(name);
    object(indent, [&] { list(*this); });
    path_.pop_back();
  }
  template <class Struct, class List>
  void optional(FileName name, const std::optional<Struct>& member, const List& list) {
    group(may_lack(name, member.has_value()), -1, [&](JsonWriter& io) { list(io, *member); });
  }

  /// Writes a list of objects, each on a line, whose members `write(io, element)` writes.
  template <class List, class Write>
  void list(FileName name, const List& elements, const Write& write) {
    begin(name);
    path_.emplace_back("[]");
    const char* separator = "[\n    ";
    for (const auto& element : elements) {
      out_ += std::exchange(separator, ",\n    ");
      object(-1, [&] { write(*this, element); });
    }
    out_ += elements.empty() ? "[]" : "\n  ]";
    path_.resize(path_.size() - 2);
  }

  /// Returns the first member that could not be written, and why: "keyframes[].position: is not
  /// finite". Empty if there is none.
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  void new_line(int indent) { out_.append("\n").append(static_cast<std::size_t>(indent), ' '); }
  void begin(FileName name) {
    const int indent = name.line >= 0 ? name.line : indent_;
    if (!is_first_) out_ += indent >= 0 ? "," : ", ";
    if (indent >= 0) new_line(indent);
    is_first_ = false;
    out_.append("\"").append(name.name).append("\": ");
    path_.push_back(name.name);
  }

  /// Writes the shortest decimal that reads back as the same double, always with a point or an
  /// exponent: otherwise readers take -0 for the integer 0 and lose the sign.
  void value(double number) {
    if (!std::isfinite(number)) {
      if (!error_.empty()) return;
      for (const std::string_view name : path_) {
        if (!error_.empty() && name != "[]") error_ += '.';
        error_ += name;
      }
      error_ += ": is not finite";
      return;
    }
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
    const std::string_view text(digits, static_cast<std::size_t>(end - digits));
    out_ += text;
    if (text.find_first_of(".e") == std::string_view::npos) out_ += ".0";
  }
  void value(std::string_view text) { out_ += json_text(nlohmann::json(text)); }
  void value(const geometry::Bounds& bounds) {
    const geometry::OptionalBounds limits = geometry::optional_bounds_of(bounds);
    const auto write = [&](FileName name, const auto& corner) { (*this)(name, corner); };
    object(-1, [&] { planning::visit_table(write, limits); });
  }
  void value(const geometry::Quat& orientation) { array(geometry::wxyz(orientation)); }
  void value(const scene::ImportOptions& reading) {
    object(-1, [&] {
      (*this)("scale", reading.scale);
      (*this)("up", reading.up);
      (*this)("unknown", reading.unknown);
      (*this)(may_lack("voxel_m", reading.voxel_m.has_value()), reading.voxel_m);
    });
  }
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
      value ? this->value(*value) : void(out_ += "null");
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
  bool is_first_ = true;
};

/// Returns a visitor of a table that writes each member.
auto each_to(JsonWriter& io) {
  return [&io](const planning::FieldSpec& spec, const auto& member) { io(spec, member); };
}

/// Writes the options that differ from the default.
void write_options(JsonWriter& io, const planning::PlanOptions& options) {
  const planning::PlanOptions usual;
  const auto write = [&]<class Member>(const planning::FieldSpec& spec, const Member& member,
                                       const Member& blank) {
    if (member == blank) return;
    if constexpr (std::same_as<Member, correction::OrientationPolicy>) {
      io.group(spec, -1, [&](JsonWriter& object) {
        planning::visit_used(
            [&](const planning::FieldSpec& inner, const auto& value) {
              if constexpr (requires { value.has_value(); }) {
                if (value) object(inner, *value);
              } else {
                object(inner, value);
              }
            },
            member);
      });
    } else if constexpr (std::same_as<Member, correction::MotionLimits>) {
      io.group(spec, -1, [&](JsonWriter& object) {
        const auto limit = [&](const planning::FieldSpec& inner, const auto& value,
                               const auto& none) {
          if (value != none) object(inner, value);
        };
        planning::visit_table(limit, member, blank);
      });
    } else {
      io(spec, member);
    }
  };
  io.group(planning::may_lack("options", options != usual), -1,
           [&](JsonWriter&) { planning::visit_table(write, options, usual); });
}

void write_body(JsonWriter& io, const motion::BodyShape& body) {
  io.group("body", -1, [&](JsonWriter& object) {
    object("type", planning::kShapeNames[body.index()]);
    std::visit([&](const auto& shape) { planning::visit_shape(each_to(object), shape); }, body);
  });
}

}  // namespace

base::Result<std::string> write_plan_request(const planning::PlanRequest& request) {
  std::string out;
  JsonWriter io(out);
  io.object(2, [&] {
    io(may_lack("scene", !request.scene.empty()), request.scene);
    const motion::Camera* const moving = planning::moving_camera(request);
    const motion::Camera& camera = moving == nullptr ? request.camera : *moving;
    io.group(may_lack("camera", moving != nullptr || camera.near_m > 0.0), -1,
             [&](JsonWriter& object) { planning::visit_table(each_to(object), camera); });
    if (moving == nullptr) write_body(io, *request.body);
    io.list("keyframes", request.keyframes, [&](JsonWriter& object, const motion::Keyframe& each) {
      object(may_lack("time", request.has_times), each.time_s);
      object("position", each.pose.position);
      object("orientation", each.pose.orientation);
      object(may_lack("image", !each.image.isZero(0.0)), each.image);
    });
    if (request.frame) io("frame", *request.frame);
    write_options(io, request.options);
  });
  out += '\n';
  if (!io.error().empty()) return base::Failure{io.error()};
  return out;
}

base::Result<std::string> write_plan_response(const planning::PlanResult& result,
                                              const ResponseFormat& format) {
  std::string out;
  JsonWriter io(out);
  io.object(2, [&] {
    planning::head_members(io, result);
    io(may_lack("scene", !format.scene.empty()), format.scene);
    io(may_lack("scene_digest", !format.scene_digest.empty()), format.scene_digest);
    io(may_lack("scene_reading", format.scene_reading.has_value()), format.scene_reading);
    io(may_lack("vertical_axis", format.vertical_axis.has_value()), format.vertical_axis);
    io(may_lack("warnings", !format.warnings.empty()), format.warnings);
    io("segments", result.path.segments());
    io("keyframes", result.keyframes);
    planning::report_members(io, result);
    io(may_lack("timing_ms", format.has_timing), result.timing);
  });
  out += '\n';
  if (!io.error().empty()) return base::Failure{io.error()};
  return out;
}

base::Result<std::string> write_path(const motion::Path& path) {
  std::string out;
  JsonWriter io(out);
  io.object(2, [&] { io("segments", path.segments()); });
  out += '\n';
  if (!io.error().empty()) return base::Failure{io.error()};
  return out;
}

}  // namespace camway::tools
