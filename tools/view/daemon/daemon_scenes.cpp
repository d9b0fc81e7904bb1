// SPDX-License-Identifier: MIT
#include "tools/view/daemon/daemon_scenes.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace camway::view {
namespace {

using Kind = SceneOrder::Kind;

ObjectFacts facts_of_object(const SceneObject& object) {
  ObjectFacts facts;
  facts.name = object.name;
  facts.kind = object.kind;
  facts.digest = object.digest;
  facts.triangles = object.num_triangles;
  facts.position_m = object.pose.position_m;
  facts.orientation_wxyz = object.pose.orientation_wxyz;
  facts.min_m = object.bounds_min_m;
  facts.max_m = object.bounds_max_m;
  return facts;
}

SceneMesh to_client(const MeshForm& form) {
  SceneMesh mesh;
  mesh.file = form.file;
  mesh.bytes.assign(form.bytes.begin(), form.bytes.end());
  mesh.format = form.format;
  mesh.scale = form.scale;
  mesh.up = static_cast<SceneMesh::Up>(form.up);
  mesh.voxel_m = form.voxel_m.value_or(0.0);
  return mesh;
}
static_assert(static_cast<int>(SceneMesh::Up::kYToZ) == static_cast<int>(scene::UpAxis::kYToZ));
static_assert(static_cast<int>(SceneMesh::Up::kZToY) == static_cast<int>(scene::UpAxis::kZToY));

SceneShape to_client(const Form& form) {
  if (const auto* const box = std::get_if<BoxForm>(&form)) {
    return SceneBox{{box->size_m[0], box->size_m[1], box->size_m[2]}};
  }
  if (const auto* const ball = std::get_if<SphereForm>(&form)) {
    return SceneSphere{ball->radius_m, ball->chord_error_m};
  }
  if (const auto* const cylinder = std::get_if<CylinderForm>(&form)) {
    return SceneCylinder{cylinder->radius_m, cylinder->height_m, cylinder->chord_error_m};
  }
  return to_client(std::get<MeshForm>(form));
}

/// Returns a refusal without the word that its code says as well, so that it begins with a member,
/// as refusals of the door itself do.
std::string without_status(const std::string& error) {
  constexpr std::string_view kInvalid = "invalid: ";
  return error.starts_with(kInvalid) ? error.substr(kInvalid.size()) : error;
}

/// Returns `pose` with what the order says.
Pose pose_of(const SceneOrder& order, Pose pose) {
  if (order.position_m) std::copy_n(order.position_m->data(), 3, pose.position_m.begin());
  if (order.orientation) {
    const geometry::Vec4 wxyz = geometry::wxyz(*order.orientation);
    std::copy_n(wxyz.data(), 4, pose.orientation_wxyz.begin());
  }
  return pose;
}

SceneAnswer move_object(Client& client, const SceneOrder& order) {
  Pose pose;
  if (!order.position_m || !order.orientation) {
    SceneAnswer described = client.describe_scene(order.scene);
    if (!described.ok()) return described;
    for (const SceneObject& object : described.objects) {
      if (object.name == order.object) pose = object.pose;
    }
  }
  return client.move_object(order.scene, order.object, pose_of(order, pose));
}

SceneAnswer call_daemon(Client& client, const SceneOrder& order) {
  switch (order.kind) {
    case Kind::kList:
      return client.list_scenes();
    case Kind::kDescribe:
      return client.describe_scene(order.scene);
    case Kind::kAdd:
      return client.put_object(order.scene, order.object, to_client(order.form),
                               pose_of(order, {}));
    case Kind::kMove:
      return move_object(client, order);
    case Kind::kRemove:
      return client.remove_object(order.scene, order.object);
  }
  return {};
}

}  // namespace

int code_of(Status status) {
  switch (status) {
    case Status::kOk:
      return code::kOk;
    case Status::kInvalid:
    case Status::kNoMap:
      return code::kInvalid;
    case Status::kUnknownScene:
      return code::kNotFound;
    case Status::kLimit:
      return code::kTooLarge;
    case Status::kOverloaded:
      return code::kTooMany;
    case Status::kCancelled:
      return code::kCancelled;
    case Status::kNoDaemon:
    case Status::kStopping:
    case Status::kNetworkUnusable:
      return code::kNoDaemon;
    case Status::kNoAnswer:
    case Status::kTimeout:
      return code::kNoAnswer;
    default:
      return code::kOurFault;
  }
}

SceneFacts facts_of(const SceneInfo& scene) {
  SceneFacts facts;
  facts.name = scene.name;
  facts.revision = scene.revision;
  facts.digest = scene.digest;
  facts.triangles = scene.num_triangles;
  facts.min_m = scene.bounds_min_m;
  facts.max_m = scene.bounds_max_m;
  facts.body_bounds = {scene.body_bounds.min_m, scene.body_bounds.max_m};
  return facts;
}

std::vector<SceneFacts> facts_of(const std::vector<SceneInfo>& scenes) {
  std::vector<SceneFacts> facts;
  for (const SceneInfo& scene : scenes) facts.push_back(facts_of(scene));
  return facts;
}

Answer ask_daemon_scene(Client& client, const SceneOrder& order, const MeshDigestOf& mesh_digest) {
  const SceneAnswer answer = call_daemon(client, order);
  if (!answer.ok()) {
    // An object that is not there is an invalid request to the daemon, and a place that is not
    // there here.
    const bool is_missing = answer.status == Status::kInvalid && order.is_change() &&
                            order.kind != Kind::kAdd &&
                            answer.error.find("object: ") != std::string::npos;
    return failure(is_missing ? code::kNotFound : code_of(answer.status),
                   without_status(answer.error));
  }
  if (order.kind == Kind::kList) return {code::kOk, scenes_json(facts_of(answer.scenes)), {}};
  std::vector<ObjectFacts> objects;
  for (const SceneObject& object : answer.objects) {
    objects.push_back(facts_of_object(object));
    objects.back().mesh_digest = mesh_digest(answer.scene, object);
  }
  return {code::kOk, objects_json(facts_of(answer.scene), objects, answer.message), {}};
}

}  // namespace camway::view
