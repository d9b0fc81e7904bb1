// SPDX-License-Identifier: MIT
#include "tools/view/review/review_data.h"

#include <fmt/format.h>

#include <cstdint>
#include <future>
#include <memory>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "daemon/base/base64.h"
#include "tools/answers/interpolation.h"

namespace camway::view {
namespace {

using Json = nlohmann::json;

/// Calls `ask` with a function that takes an answer, and waits for that.
template <class Ask>
Answer wait_for(const Ask& ask) {
  const auto promise = std::make_shared<std::promise<Answer>>();
  ask([promise](Answer answer) { promise->set_value(std::move(answer)); });
  return promise->get_future().get();
}

void add_index(const Json& value, std::set<std::int64_t>& indices) {
  if (value.is_number_integer() && indices.size() < kMostIndices) {
    indices.insert(value.get<std::int64_t>());
  }
}

/// Adds the numbers of triangles that an answer names: those of witnesses, closed surfaces, cages.
void add_indices(const Json& value, std::set<std::int64_t>& indices) {
  if (value.is_array()) {
    for (const Json& element : value) add_indices(element, indices);
  }
  if (!value.is_object()) return;
  for (const auto& [key, member] : value.items()) {
    if (key == "triangle") add_index(member, indices);
    if (key == "triangles" && member.is_array()) {
      for (const Json& index : member) add_index(index, indices);
    } else {
      add_indices(member, indices);
    }
  }
}

/// Returns the member `compared` of a review and a comma; empty if there is nothing to compare.
std::string compared_member(const std::optional<ComparedAnswer>& compared) {
  if (!compared) return {};
  return fmt::format(R"("compared":{{"name":{},"otherName":{},"other":{}}},)",
                     json_string(compared->name), json_string(compared->other_name),
                     compared->other);
}

}  // namespace

std::nullopt_t ReviewSource::fail(int code, std::string error) {
  failed_ = failure(code, std::move(error));
  return std::nullopt;
}

std::optional<ReviewScene> ReviewSource::scene(const std::string& name) {
  SceneOrder order;
  order.kind = SceneOrder::Kind::kDescribe;
  order.scene = name;
  Answer answer = wait_for([&](Done done) { backend_.ask_scene(order, std::move(done)); });
  if (answer.code != code::kOk) return fail(answer.code, std::move(answer.error));
  ReviewScene scene{std::move(answer.json), {}};
  std::set<std::string> digests;
  const Json description = Json::parse(scene.description);
  for (const Json& object : description.at("objects")) {
    std::string digest = object.at("digest");
    if (!digests.insert(digest).second) continue;
    std::string key = object.value("mesh_digest", digest);
    scene.meshes.push_back({std::move(digest), std::move(key)});
  }
  return scene;
}

std::optional<std::string> ReviewSource::mesh(const std::string& scene, const std::string& digest) {
  const GlbAnswer mesh = meshes_.wait_for(scene, digest);
  if (!mesh.glb) return fail(mesh.code, mesh.error);
  return base::encode_base64(*mesh.glb);
}

std::optional<std::string> ReviewSource::plan_members(const ReviewOrder& order) {
  const base::Result<std::string> before = tools::interpolated_text(order.plan.request);
  if (!before) {
    return fail(code::kInvalid, "request: the path cannot be written: " + before.error);
  }
  const std::optional<std::string> triangles = this->triangles(order);
  if (!triangles) return std::nullopt;
  return fmt::format(R"("request":{},"answer":{},"before":{},{}"triangles":{})", *order.plan.text,
                     order.answer, *before, compared_member(order.compared), *triangles);
}

std::optional<std::string> ReviewSource::triangles(const ReviewOrder& order) {
  std::set<std::int64_t> indices;
  add_indices(Json::parse(order.answer), indices);
  if (order.compared) add_indices(Json::parse(order.compared->other), indices);
  const std::vector<std::int64_t> list(indices.begin(), indices.end());
  Answer answer =
      wait_for([&](Done done) { backend_.triangles(order.plan.scene, list, std::move(done)); });
  if (answer.code != code::kOk) return fail(answer.code, std::move(answer.error));
  return Json::parse(answer.json).at("triangles").dump();
}

std::string json_for_html(std::string_view json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace camway::view
