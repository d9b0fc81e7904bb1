// SPDX-License-Identifier: MIT
#include "tools/view/orders.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

#include "daemon/base/base64.h"
#include "daemon/planning/request/validate.h"
#include "daemon/scene/import/record/import_words.h"
#include "tools/json/json_reader.h"

namespace camway::view {
namespace {

using Json = nlohmann::json;
using tools::DocumentNotes;
using tools::Field;

constexpr std::size_t kLongestObjectName = 64;  // as a daemon has it
constexpr std::size_t kLongestSceneName = 128;  // as a daemon has it
constexpr std::size_t kLongestDragName = 64;
constexpr std::size_t kLongestFormat = 16;
/// Whole numbers up to here are exact in every reader of JSON.
constexpr std::int64_t kLargestId = std::int64_t{1} << 53;

bool is_name(std::string_view text, std::size_t longest) {
  return !text.empty() && text.size() <= longest && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '-';
  });
}

std::string read_name(const Field& field, std::size_t longest) {
  std::string name = field.text();
  if (!is_name(name, longest))
    field.fail(fmt::format("must be of [A-Za-z0-9_.-]{{1,{}}}", longest));
  return name;
}

/// Returns the scene of the member `scene`; empty without one.
std::string read_scene_name(const Field& root) {
  const std::optional<Field> scene = root.optional_member("scene");
  return scene ? read_name(*scene, kLongestSceneName) : std::string();
}

double read_length(const Field& field) {
  const double length_m = field.number();
  if (!(length_m > 0.0)) field.fail_number("be above 0");
  return length_m;
}

double read_chord_error(const Field& form) {
  const std::optional<Field> field = form.optional_member("chord_error_m");
  return field ? read_length(*field) : 0.0;
}

Form read_box(const Field& field) {
  field.allow_only({"type", "size"});
  BoxForm box;
  field.member("size").numbers(box.size_m.data(), 3);
  if (!(box.size_m.minCoeff() > 0.0)) field.member("size").fail("must be above 0 on each axis");
  return box;
}

Form read_sphere(const Field& field) {
  field.allow_only({"type", "radius_m", "chord_error_m"});
  return SphereForm{read_length(field.member("radius_m")), read_chord_error(field)};
}

Form read_cylinder(const Field& field) {
  field.allow_only({"type", "radius_m", "height_m", "chord_error_m"});
  return CylinderForm{read_length(field.member("radius_m")), read_length(field.member("height_m")),
                      read_chord_error(field)};
}

void read_content(const Field& field, MeshForm& mesh) {
  const std::optional<Field> text = field.optional_member("text");
  const std::optional<Field> base64 = field.optional_member("base64");
  if (text && base64) field.fail("has both text and base64; leave one out");
  if (text) {
    mesh.bytes = text->text();
  } else if (base64) {
    std::optional<std::string> bytes = base::decode_base64(base64->text());
    if (!bytes) base64->fail("is no base64");
    if (bytes) mesh.bytes = *std::move(bytes);
  } else {
    field.fail("has none of file, text and base64");
  }
  const Field format = field.member("format");
  mesh.format = format.text();
  const bool is_extension = !mesh.format.empty() && mesh.format.size() <= kLongestFormat &&
                            std::ranges::all_of(mesh.format, [](char c) {
                              return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
                            });
  if (!is_extension) format.fail("must be the extension of a file in small letters, as obj");
  if (mesh.bytes.empty()) field.fail("is empty");
}

Form read_mesh_form(const Field& field) {
  field.allow_only({"type", "file", "text", "base64", "format", "scale", "up", "voxel_m"});
  MeshForm mesh;
  if (const std::optional<Field> file = field.optional_member("file")) {
    mesh.file = file->text();
    if (mesh.file.empty()) file->fail("is empty");
    for (const std::string_view other : {"text", "base64", "format"}) {
      if (field.optional_member(other))
        field.fail(fmt::format("has both file and {}; leave one out", other));
    }
  } else {
    read_content(field, mesh);
  }
  if (const std::optional<Field> scale = field.optional_member("scale"))
    mesh.scale = read_length(*scale);
  if (const std::optional<Field> up = field.optional_member("up")) tools::read_value(*up, mesh.up);
  if (const std::optional<Field> voxel = field.optional_member("voxel_m")) {
    mesh.voxel_m = read_length(*voxel);
  }
  return mesh;
}

Form read_form(const Field& field) {
  constexpr std::array<std::string_view, 4> kTypes{"box", "sphere", "cylinder", "mesh"};
  constexpr std::array<Form (*)(const Field&), 4> kFormReaders{read_box, read_sphere, read_cylinder,
                                                               read_mesh_form};
  const std::size_t type = tools::named(field.member("type"), kTypes);
  // Otherwise the members of another type would be named as unknown.
  return field.failed() ? Form() : kFormReaders.at(type)(field);
}

void read_pose(const Field& root, SceneOrder& order) {
  if (const std::optional<Field> position = root.optional_member("position")) {
    position->numbers(order.position_m.emplace(geometry::Vec3::Zero()).data(), 3);
  }
  if (const std::optional<Field> orientation = root.optional_member("orientation")) {
    geometry::Vec4 wxyz = geometry::Vec4::Zero();
    orientation->numbers(wxyz.data(), 4);
    if (wxyz.isZero(0.0)) orientation->fail("has length zero, which is no orientation");
    order.orientation = geometry::from_wxyz(wxyz);
  }
}

void read_indices(const Field& root, TrianglesOrder& order) {
  const Field indices = root.member("indices");
  const std::size_t count = indices.size();
  if (count > kMostIndices) {
    return indices.fail(fmt::format("has {} numbers, and may have {}", count, kMostIndices));
  }
  order.indices.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    order.indices.push_back(indices.element(i).integer(-kLargestId, kLargestId));
  }
}

void read_addition(const Field& root, std::string_view name, SceneOrder& order) {
  order.kind = SceneOrder::Kind::kAdd;
  order.object = read_name(root.member(name), kLongestObjectName);
  order.form = read_form(root.member("form"));
  read_pose(root, order);
}

void read_move(const Field& root, SceneOrder& order) {
  order.kind = SceneOrder::Kind::kMove;
  read_pose(root, order);
  if (!order.position_m && !order.orientation) {
    root.fail("has neither position nor orientation; one of both says where the object is to be");
  }
}

/// Reads an order of the members of `document`. Errors about the document itself begin with
/// "the request".
template <class Order = SceneOrder, class Read>
base::Result<Order> read_order(const Json& document, const Read& read) {
  DocumentNotes notes;
  Order order;
  read(Field(document, notes), order);
  if (!notes.error.empty()) return base::Failure{notes.error};
  return order;
}

base::Result<CheckOrder> read_check(const Json& request, const Json& path) {
  base::Result<PlanOrder> plan = read_plan(request);
  if (!plan) return base::Failure{plan.error};
  base::Result<tools::PathFile> file = tools::read_document<tools::PathFile>(path, "path");
  if (!file) return base::Failure{file.error};
  return CheckOrder{std::move(plan->scene), std::move(plan->request), *std::move(file)};
}

/// Reads the messages of sockets. Their parts that are documents are read as these.
class MessageReader {
 public:
  explicit MessageReader(const Json& document) : document_(document), root_(document, notes_) {}

  std::variant<Message, BadMessage> read() {
    Message message;
    if (!document_.is_object()) {
      return BadMessage{std::nullopt, "the message must be an object"};
    }
    message.id = root_.member("id").integer(0, kLargestId);
    if (root_.failed()) return BadMessage{std::nullopt, notes_.error};
    read_what(message);
    if (!notes_.error.empty()) return BadMessage{message.id, notes_.error, is_change_};
    return message;
  }

 private:
  /// The orders that a message may have, in the order of `kVerbs`.
  enum class Verb : std::uint8_t {
    kPlan,
    kCheck,
    kCancel,
    kStatus,
    kVersion,
    kWatch,
    kUnwatch,
    kInterpolate,
    kTriangles,
    kFields,
    kLast,
    kSceneList,  // from here in the order of `SceneOrder::Kind`
    kSceneDescribe,
    kSceneAdd,
    kSceneMove,
    kSceneRemove,
  };
  static constexpr std::array<std::string_view, 16> kVerbs{
      "plan",           "check",       "cancel",     "status",      "version", "watch",
      "unwatch",        "interpolate", "triangles",  "fields",      "last",    "scene.list",
      "scene.describe", "scene.add",   "scene.move", "scene.remove"};

  void read_what(Message& message) {
    const auto verb = static_cast<Verb>(tools::named(root_.member("do"), kVerbs));
    if (root_.failed()) return;
    is_change_ = verb >= Verb::kSceneAdd;
    switch (verb) {
      case Verb::kPlan:
        return read_plan_message(message);
      case Verb::kCheck:
        return read_check_message(message);
      case Verb::kCancel:
        return read_bare<Message::Cancel>(message);
      case Verb::kStatus:
        return read_bare<Message::Status>(message);
      case Verb::kVersion:
        return read_bare<Message::Version>(message);
      case Verb::kWatch:
        return read_watch(message);
      case Verb::kUnwatch:
        return read_bare<Message::Unwatch>(message);
      case Verb::kInterpolate:
        return read_interpolate(message);
      case Verb::kTriangles:
        return read_triangles_message(message);
      case Verb::kFields:
        return read_bare<Message::Fields>(message);
      case Verb::kLast:
        return read_bare<Message::Last>(message);
      default:
        break;
    }
    const int kind = static_cast<int>(verb) - static_cast<int>(Verb::kSceneList);
    read_scene_message(static_cast<SceneOrder::Kind>(kind), message);
  }

  template <class What>
  void read_bare(Message& message) {
    root_.allow_only({"id", "do"});
    message.what = What{};
  }

  /// Returns the member, or records that it is missing.
  const Json* part(const char* name) {
    static_cast<void>(root_.member(name));
    return root_.failed() ? nullptr : &document_.at(name);
  }

  /// Takes over a result or its error.
  template <class Value>
  bool take(base::Result<Value> result, Value& value) {
    if (!result) {
      root_.fail(result.error);
      return false;
    }
    value = *std::move(result);
    return true;
  }

  void read_plan_message(Message& message) {
    root_.allow_only({"id", "do", "request", "progress", "drag", "finish"});
    Message::Plan plan;
    if (const auto progress = root_.optional_member("progress"))
      plan.wants_progress = progress->boolean();
    if (const auto drag = root_.optional_member("drag"))
      plan.drag = read_name(*drag, kLongestDragName);
    if (const auto finish = root_.optional_member("finish")) {
      plan.may_finish = finish->boolean();
      if (plan.drag.empty()) finish->fail("does not count without a drag");
    }
    const Json* const request = part("request");
    if (request == nullptr || !take(read_plan(*request), plan.order)) return;
    message.what = std::move(plan);
  }

  void read_check_message(Message& message) {
    root_.allow_only({"id", "do", "request", "path"});
    const Json* const request = part("request");
    const Json* const path = part("path");
    CheckOrder order;
    if (path == nullptr || !take(read_check(*request, *path), order)) return;
    message.what = std::move(order);
  }

  void read_interpolate(Message& message) {
    root_.allow_only({"id", "do", "request"});
    const Json* const request = part("request");
    Message::Interpolate interpolate;
    if (request == nullptr || !take(read_plan(*request), interpolate.order)) return;
    message.what = std::move(interpolate);
  }

  void read_triangles_message(Message& message) {
    root_.allow_only({"id", "do", "scene", "indices"});
    TrianglesOrder order;
    order.scene = read_scene_name(root_);
    read_indices(root_, order);
    message.what = std::move(order);
  }

  void read_watch(Message& message) {
    root_.allow_only({"id", "do", "request"});
    Message::Watch watch;
    if (root_.optional_member("request")) {
      PlanOrder order;
      if (!take(read_plan(document_.at("request")), order)) return;
      watch.order = std::move(order);
    }
    message.what = std::move(watch);
  }

  void read_scene_message(SceneOrder::Kind kind, Message& message) {
    SceneOrder order;
    std::vector<std::string_view> known{"id", "do"};
    if (kind != SceneOrder::Kind::kList) known.emplace_back("scene");
    if (kind >= SceneOrder::Kind::kAdd) known.emplace_back("object");
    if (kind == SceneOrder::Kind::kAdd) known.emplace_back("form");
    if (kind == SceneOrder::Kind::kAdd || kind == SceneOrder::Kind::kMove) {
      known.insert(known.end(), {"position", "orientation"});
    }
    root_.allow_only(known);
    order.scene = read_scene_name(root_);
    if (kind >= SceneOrder::Kind::kMove) {
      order.object = read_name(root_.member("object"), kLongestObjectName);
    }
    if (kind == SceneOrder::Kind::kAdd) read_addition(root_, "object", order);
    if (kind == SceneOrder::Kind::kMove) read_move(root_, order);
    order.kind = kind;
    message.what = std::move(order);
  }

  const Json& document_;
  DocumentNotes notes_;
  Field root_;
  bool is_change_ = false;
};

}  // namespace

std::string scene_of(const tools::RequestFile& request) {
  return std::filesystem::path(request.scene).stem().string();
}

base::Result<PlanOrder> read_plan(const Json& document) {
  base::Result<tools::RequestFile> request =
      tools::read_document<tools::RequestFile>(document, "request");
  if (!request) return base::Failure{request.error};
  if (request->body_file) {
    return base::Failure{
        "request: body.file: is a file, which is not read here; send vertices and triangles"};
  }
  if (const auto fault = planning::validate(*request)) {
    return base::Failure{"request: " + fault->message};
  }
  auto text = std::make_shared<const std::string>(
      document.dump(-1, ' ', false, Json::error_handler_t::replace));
  return PlanOrder{scene_of(*request), *std::move(request), std::move(text)};
}

base::Result<CheckOrder> read_check_document(const Json& document) {
  DocumentNotes notes;
  const Field root(document, notes);
  root.allow_only({"request", "path"});
  for (const char* const part : {"request", "path"}) static_cast<void>(root.member(part));
  if (root.failed()) return base::Failure{notes.error};
  return read_check(document.at("request"), document.at("path"));
}

base::Result<TrianglesOrder> read_triangles(const Json& document) {
  return read_order<TrianglesOrder>(document, [](const Field& root, TrianglesOrder& order) {
    root.allow_only({"indices"});
    read_indices(root, order);
  });
}

base::Result<SceneOrder> read_added(const Json& document) {
  return read_order(document, [](const Field& root, SceneOrder& order) {
    root.allow_only({"name", "form", "position", "orientation"});
    read_addition(root, "name", order);
  });
}

base::Result<SceneOrder> read_moved(const Json& document) {
  return read_order(document, [](const Field& root, SceneOrder& order) {
    root.allow_only({"position", "orientation"});
    read_move(root, order);
  });
}

std::variant<Message, BadMessage> read_message(std::string_view text) {
  const base::Result<Json> document = tools::parse_document(text, "message");
  if (!document) return BadMessage{std::nullopt, document.error};
  return MessageReader(*document).read();
}

}  // namespace camway::view
