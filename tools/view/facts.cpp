// SPDX-License-Identifier: MIT
#include "tools/view/facts.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace camway::view {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// Returns bounds as requests have them, where null is no limit.
OrderedJson bounds_json(const geometry::OptionalBounds& bounds) {
  const auto corner = [](const auto& limits) {
    OrderedJson json = OrderedJson::array();
    for (const auto& limit : limits) json.push_back(limit ? OrderedJson(*limit) : OrderedJson());
    return json;
  };
  return {{"min", corner(bounds.min_m)}, {"max", corner(bounds.max_m)}};
}

OrderedJson scene_json(const SceneFacts& scene) {
  return {{"name", scene.name},
          {"revision", scene.revision},
          {"digest", scene.digest},
          {"triangles", scene.triangles},
          {"bounds_min_m", scene.min_m},
          {"bounds_max_m", scene.max_m},
          {"body_bounds", bounds_json(scene.body_bounds)}};
}

OrderedJson object_json(const ObjectFacts& object) {
  OrderedJson json{{"name", object.name},           {"kind", object.kind},
                   {"digest", object.digest},       {"triangles", object.triangles},
                   {"position", object.position_m}, {"orientation", object.orientation_wxyz},
                   {"bounds_min_m", object.min_m},  {"bounds_max_m", object.max_m}};
  if (!object.mesh_digest.empty()) json["mesh_digest"] = object.mesh_digest;
  return json;
}

/// Names from files may hold any bytes.
std::string text_of(const OrderedJson& json) {
  return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

}  // namespace

std::string scenes_json(const std::vector<SceneFacts>& scenes) {
  OrderedJson list = OrderedJson::array();
  for (const SceneFacts& scene : scenes) list.push_back(scene_json(scene));
  return text_of({{"scenes", std::move(list)}});
}

std::string objects_json(const SceneFacts& scene, const std::vector<ObjectFacts>& objects,
                         const std::string& warnings) {
  OrderedJson list = OrderedJson::array();
  for (const ObjectFacts& object : objects) list.push_back(object_json(object));
  OrderedJson json{{"scene", scene_json(scene)}, {"objects", std::move(list)}};
  if (!warnings.empty()) json["warnings"] = warnings;
  return text_of(json);
}

std::string triangles_json(std::int64_t revision,
                           const std::map<std::int64_t, geometry::Triangle>& triangles) {
  OrderedJson members = OrderedJson::object();
  for (const auto& [index, triangle] : triangles) {
    OrderedJson corners = OrderedJson::array();
    for (const geometry::Vec3& corner : triangle) {
      corners.push_back({corner.x(), corner.y(), corner.z()});
    }
    members[std::to_string(index)] = std::move(corners);
  }
  return text_of({{"revision", revision}, {"triangles", std::move(members)}});
}

}  // namespace camway::view
