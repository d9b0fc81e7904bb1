// SPDX-License-Identifier: MIT
#include "tools/json/json_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/planning/request/body_members.h"
#include "daemon/planning/request/option_table.h"
#include "daemon/scene/import/record/import_words.h"
#include "tools/json/json_reader.h"

namespace camway::tools {
namespace {

using correction::OrientationPolicy;
using correction::OrientationRule;
using geometry::Vec3;
using motion::Keyframe;
using planning::FieldSpec;
using planning::may_lack;

/// Reads the members of a body.
struct ShapeReader : JsonReader {
  using JsonReader::JsonReader;
  using JsonReader::operator();

  /// Reads a list of points for each piece, or `points` for a single piece.
  void operator()(const FieldSpec& spec, std::vector<std::vector<Vec3>>& pieces) const {
    const auto points = object_.optional_member(planning::body::kPoints.name);
    const auto lists = object_.optional_member(spec.name);
    if (points.has_value() == lists.has_value()) {
      object_.fail("must have either points or pieces");
    } else if (points) {
      read_value(*points, pieces.emplace_back());
    } else {
      read_value(*lists, pieces);
    }
  }
};

/// Reads the body: an object with a `type` and the members of that type
/// (`planning/request/body_members.h`), in metres and in the camera frame.
///
///     {"type": "camera"}
///     {"type": "box", "size": [x, y, z], "center": [x, y, z]}
///     {"type": "sphere", "radius_m": r, "center": [x, y, z]}
///     {"type": "convex", "points": [[x, y, z], ...]}
///     {"type": "convex", "pieces": [[[x, y, z], ...], ...]}
///     {"type": "mesh", "vertices": [[x, y, z], ...], "triangles": [[i, j, k], ...],
///      "solid": true}
///
/// Returns nothing for a camera, and after an error.
std::optional<motion::BodyShape> read_body(const Field& field) {
  std::optional<motion::BodyShape> shape =
      planning::blank_shape(named(field.member("type"), planning::kShapeNames));
  const auto read = [&](auto& part) {
    std::vector<std::string_view> names = {"type"};
    if constexpr (requires { part.pieces_C; }) names.push_back(planning::body::kPoints.name);
    allow_only(field, names, [&](const auto& visit) { planning::visit_shape(visit, part); });
    planning::visit_shape(ShapeReader(field), part);
  };
  std::visit(read, *shape);
  if (std::holds_alternative<motion::Camera>(*shape)) shape.reset();
  return shape;
}

/// Reads a body whose mesh is in a file of its own.
///
///     {"type": "mesh", "file": "piano.obj", "scale": 0.001, "solid": true}
BodyFile read_body_file(const Field& field) {
  field.allow_only({"type", "file", "scale", "solid"});
  const JsonReader io(field);
  BodyFile body;
  const Field type = field.member("type");
  if (type.text() != "mesh") type.fail("must be mesh for a body with a file");
  io(planning::FileName{"file"}, body.file);
  io(may_lack("scale"), body.scale);
  io(may_lack("solid"), body.solid);
  if (body.file.empty()) field.member("file").fail("is empty; it must name a mesh file");
  if (!(body.scale > 0.0 && std::isfinite(body.scale)))
    field.member("scale").fail("must be above 0 and finite");
  return body;
}

/// Reads the time of the last keyframe, which must have one exactly if the first one has one.
void read_time(const Field& item, RequestFile& request) {
  const std::optional<Field> time = item.optional_member("time");
  if (time) request.keyframes.back().time_s = time->number();
  if (request.keyframes.size() == 1) request.has_times = time.has_value();
  if (time.has_value() == request.has_times) return;
  item.fail(std::string(time ? "has a time and keyframe 0 has none"
                             : "has no time and keyframe 0 has one") +
            ": time stands in all keyframes or in none");
}

/// Reads the quaternion, in either order of its numbers, and brings it to unit length.
geometry::Quat read_orientation(const Field& item, RequestFile& request) {
  const auto xyzw = item.optional_member("orientation_xyzw");
  if (xyzw && item.optional_member("orientation")) {
    item.fail("has both orientation and orientation_xyzw; leave one out");
  }
  if (xyzw) request.says_xyzw = true;
  const Field field = xyzw ? *xyzw : item.member("orientation");
  geometry::Vec4 numbers = geometry::Vec4::Zero();
  read_value(field, numbers);
  if (numbers.isZero(0.0)) field.fail("has length zero, which is no orientation");
  if (xyzw) numbers = {numbers[3], numbers[0], numbers[1], numbers[2]};
  return geometry::from_wxyz(planning::direction_of(numbers));
}

void read_keyframes(const Field& list, RequestFile& request) {
  read_list(list, request.keyframes, [&](const Field& item, Keyframe& keyframe) {
    // Keyframes copied from a response have an origin, which is then "given".
    item.allow_only(
        {"time", "position", "orientation", "orientation_xyzw", "origin", "repaired", "image"});
    read_time(item, request);
    const JsonReader io(item);
    io("position", keyframe.pose.position);
    keyframe.pose.orientation = read_orientation(item, request);
    io(may_lack("image"), keyframe.image);
  });
}

motion::PathFrame read_frame(const Field& field) {
  field.allow_only({"reference", "begin", "end"});
  for (const std::string_view end : {"begin", "end"}) {
    field.member(end).allow_only({"velocity_m_per_s", "image_rate_per_s"});
  }
  motion::PathFrame frame;
  read_value(field, frame);
  return frame;
}

}  // namespace

void read_value(const Field& field, SceneReading& reading) {
  const JsonReader io(field);
  io(may_lack("scale"), reading.scale);
  if (reading.scale && !(*reading.scale > 0.0)) field.member("scale").fail_number("be above 0");
  io(may_lack("up"), reading.up);
  io(may_lack("unknown"), reading.unknown);
  io(may_lack("voxel_m"), reading.voxel_m);
  if (reading.voxel_m && !scene::VoxelGrid::valid_resolution(*reading.voxel_m)) {
    field.member("voxel_m").fail_number(fmt::format("be from {:g} to {:g}",
                                                    scene::VoxelGrid::kMinResolutionM,
                                                    scene::VoxelGrid::kMaxResolutionM));
  }
}

void read_value(const Field& field, OrientationPolicy& policy) {
  read_table(field, policy);
  policy.up_W = planning::direction_of(policy.up_W);
  std::vector<std::string_view> used;
  planning::visit_used([&](const FieldSpec& spec, auto&) { used.push_back(spec.name); }, policy);
  planning::visit_specs<OrientationPolicy>([&](const FieldSpec& spec) {
    const auto member = field.optional_member(spec.file_name());
    if (!member || std::ranges::count(used, spec.name) > 0) return;
    member->fail("does not count with this policy; leave it out, or set the one it belongs to");
  });
  if (policy.rule == OrientationRule::kTarget) static_cast<void>(field.member("target"));
}

void read_value(const Field& field, planning::PlanOptions& options) { read_table(field, options); }

planning::FieldSpelling json_spelling(const DocumentNotes& notes) {
  return [old_names = notes.old_names](std::string_view path) {
    const std::string name = planning::spell(path, planning::Spelling::kFile);
    const auto old_name = old_names.find(name);
    return old_name == old_names.end() ? name : old_name->second;
  };
}

void read_value(const Field& root, RequestFile& request) {
  root.allow_only({"scene", "scale", "up", "unknown", "voxel_m", "camera", "body", "keyframes",
                   "frame", "options"});
  const JsonReader io(root);
  io(may_lack("scene"), request.scene);
  read_value(root, request.reading);
  if (const auto body = root.optional_member("body")) {
    if (body->optional_member("file")) {
      request.body_file = read_body_file(*body);
      request.body = motion::MeshShape{};
    } else {
      request.body = read_body(*body);
    }
  }
  if (!request.body || root.optional_member("camera")) {
    read_value(root.member("camera"), request.camera);
  }
  read_keyframes(root.member("keyframes"), request);
  const auto remark = root.optional_member("_camera");
  const std::string format = remark ? remark->remark("format") : "";
  // The order of a log's numbers is what the user, or a guess, says.
  request.has_imported_order = !format.empty() && format != "lcm";
  if (const auto frame = root.optional_member("frame")) request.frame = read_frame(*frame);
  io(may_lack("options"), request.options);
  request.spelling = json_spelling(root.notes());
}

}  // namespace camway::tools
